// Every pass belongs to a stage.
#include "render/pass_stage.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lumulus {
namespace {

TEST(PassStage, TellsWhatAPassIsFor) {
    EXPECT_EQ(stageOf("trace"), Stage::photons);
    EXPECT_EQ(stageOf("light field"), Stage::light);
    EXPECT_EQ(stageOf("march"), Stage::draw);
    EXPECT_EQ(stageOf("fog up"), Stage::fog);
}

TEST(PassStage, APassThatIsNotListedIsAMistake) {
    EXPECT_THROW(stageOf("a new pass"), std::logic_error);
}

}  // namespace
}  // namespace lumulus
