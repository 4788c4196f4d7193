#include "gpu/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "gpu/reflection.h"
#include "gpu/shaders/interface.h"
#include "gpu/test_programs.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using shared::ScalePush;
using testing::HasSubstr;
using testing::ThrowsMessage;
using ProgramTest = test::VulkanTest;

TEST(Reflection, SizeOfPushConstantsEndsWithTheLastMember) {
    EXPECT_EQ(sizeof(ScalePush), 16U);
    EXPECT_EQ(reflect(test::scale_comp).pushBytes, 12U);
}

TEST(Reflection, NamesAndQualifiersOfBindings) {
    const Reflection copy = reflect(test::copy_comp);
    ASSERT_EQ(copy.bindings.size(), 2U);
    EXPECT_EQ(copy.bindings[0].name, "source");  // the instance, not the block
    EXPECT_TRUE(copy.bindings[0].reads);
    EXPECT_FALSE(copy.bindings[0].writes);
    EXPECT_EQ(copy.bindings[1].name, "target");
    EXPECT_FALSE(copy.bindings[1].reads);
    EXPECT_TRUE(copy.bindings[1].writes);

    const Reflection scale = reflect(test::scale_comp);
    ASSERT_EQ(scale.bindings.size(), 1U);
    EXPECT_EQ(scale.bindings[0].name, "Numbers");  // the block, which has no instance
    EXPECT_TRUE(scale.bindings[0].reads);
    EXPECT_TRUE(scale.bindings[0].writes);
}

TEST(Reflection, KindsOfImages) {
    const Reflection reflection = reflect(test::fetch_integers_comp);
    ASSERT_EQ(reflection.bindings.size(), 2U);
    const BindingInfo& sampled = reflection.bindings[0];
    EXPECT_EQ(sampled.name, "picture");
    EXPECT_EQ(sampled.kind, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    EXPECT_TRUE(sampled.reads);
    EXPECT_FALSE(sampled.writes);
    const BindingInfo& stored = reflection.bindings[1];
    EXPECT_EQ(stored.name, "doubled");
    EXPECT_EQ(stored.kind, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    EXPECT_EQ(stored.dimensions, 2);
    EXPECT_FALSE(stored.reads);
    EXPECT_TRUE(stored.writes);
    EXPECT_EQ(reflect(test::sample_volume_comp).bindings.front().dimensions, 3);
}

TEST(Reflection, UniformBlockIsRefused) {
    EXPECT_THAT([] { reflect(test::unsupported_comp); }, ThrowsMessage<std::logic_error>(HasSubstr("uniform blocks")));
}

TEST(Reflection, WordsThatAreNotSpirvAreRefused) {
    const std::uint32_t words[] = {1, 2, 3, 4, 5};
    EXPECT_THROW(reflect(words), std::logic_error);
}

TEST_F(ProgramTest, PushConstantsOfAnotherSizeAreRefused) {
    EXPECT_THAT([&] { Program<std::uint32_t>(context, "scale", test::scale_comp); },
                ThrowsMessage<std::logic_error>(AllOf(HasSubstr("scale"), HasSubstr("4 bytes"), HasSubstr("12"))));
    EXPECT_THROW(Program<NoPush>(context, "scale", test::scale_comp), std::logic_error);
    EXPECT_THROW(Program<ScalePush>(context, "copy", test::copy_comp), std::logic_error);
}

TEST_F(ProgramTest, UnknownSpecialisationConstantIsRefused) {
    EXPECT_THAT([&] { Program<ScalePush>(context, "scale", test::scale_comp, {SpecConstant::of(9, 1)}); },
                ThrowsMessage<std::logic_error>(HasSubstr("constant_id 9")));
}

}  // namespace
}  // namespace lumulus::gpu
