// Which word of a command line is blamed, and what is advised instead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "cli/advice.h"

namespace lumulus::cli {
namespace {

using testing::HasSubstr;

class Advice : public testing::Test {
  protected:
    CLI::App app{"", "lumulus"};
    std::string text, output, quality;
    std::vector<double> sun;
    bool quiet = false;

    void SetUp() override {
        app.add_option("--threads", text);
        CLI::App* render = app.add_subcommand("render", "");
        render->add_option("scene", text);
        render->add_option("-o,--output", output);
        render->add_option("--quality", quality);
        render->add_flag("--quiet", quiet);
        CLI::App* fetch = app.add_subcommand("fetch", "");
        fetch->add_option("--sun", sun)->expected(2);
    }

    std::string blamed(const std::vector<const char*>& words) {
        try {
            refuseUnknownWords(app, words);
        } catch (const InputError& e) {
            return e.what();
        }
        return "nothing";
    }
};

TEST_F(Advice, RightWordsPass) {
    for (const std::vector<const char*>& words :
         std::vector<std::vector<const char*>>{{"render", "s.toml", "-o", "a.png", "--quiet"},
                                               {"render", "-oa.png", "--quality=draft", "s.toml", "--", "--nonsense"},
                                               {"--threads", "2", "render", "s.toml"},
                                               {"--threads=2", "render", "render"},
                                               {"fetch", "--sun", "-30", "-.5"},
                                               {"render", "-"}})
        EXPECT_EQ(blamed(words), "nothing");
}

TEST_F(Advice, TheWrongWordIsNamedWithTheNearest) {
    EXPECT_EQ(blamed({"rendr", "s.toml"}), "unknown command \"rendr\" (command line): did you mean render?");
    EXPECT_EQ(blamed({"render", "--qualty", "draft", "s.toml"}),
              "unknown option \"--qualty\" (lumulus render): did you mean --quality?");
    EXPECT_EQ(blamed({"render", "-quality", "draft"}),
              "unknown option \"-quality\" (lumulus render): did you mean --quality?");
    EXPECT_EQ(blamed({"render", "s.toml", "--outptu=a.png"}),
              "unknown option \"--outptu\" (lumulus render): did you mean --output?");
    EXPECT_EQ(blamed({"--thread", "2", "render"}), "unknown option \"--thread\" (lumulus): did you mean --threads?");
}

TEST_F(Advice, DashesOfTypography) {
    for (const char* word : {"\u2014quality", "\u2013quality", "\u2013-quality", "\u2013\u2013quality"})
        EXPECT_EQ(blamed({"render", "s.toml", word, "draft"}),
                  "unknown option \"" + std::string(word) +
                      "\" (lumulus render): did you mean --quality, with plain dashes?");
    EXPECT_THAT(blamed({"render", "\u2013o", "a.png"}), HasSubstr("did you mean -o, with plain dashes?"));
    EXPECT_THAT(blamed({"render", "\u2014qualty", "draft"}), HasSubstr("did you mean --quality?"));
    EXPECT_EQ(blamed({"render", "\u2014"}), "nothing") << "a name like any other";
}

TEST_F(Advice, WhereNothingIsNear) {
    EXPECT_THAT(blamed({"denoise"}), HasSubstr("the commands are render, fetch"));
    EXPECT_THAT(blamed({"s.toml"}), HasSubstr("did you mean lumulus render s.toml?"));
    EXPECT_THAT(blamed({"--quiet", "render", "s.toml"}),
                HasSubstr("write it behind the command: lumulus render --quiet"));
    EXPECT_THAT(blamed({"render", "--sun", "1", "2"}), HasSubstr("lumulus fetch has such an option"));
    EXPECT_THAT(blamed({"render", "--nonsense"}), HasSubstr("see lumulus render --help"));
    EXPECT_THAT(blamed({"render", "-x"}), HasSubstr("unknown option \"-x\""));
    EXPECT_THAT(blamed({"render", ("--" + std::string(100000, 'x')).c_str()}), HasSubstr("see lumulus render --help"));
}

}  // namespace
}  // namespace lumulus::cli
