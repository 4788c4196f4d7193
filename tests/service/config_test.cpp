// service.toml: the shipped one, and what is refused.
#include "service/net/config.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/temporary_folder.h"

namespace lumulus::service {
namespace {

using test::TemporaryFolder;

class ConfigTest : public testing::Test {
  protected:
    TemporaryFolder folder;

    void SetUp() override { std::filesystem::create_directory(folder / "scenes"); }
    Config load(const std::string& toml) {
        test::writeAll(folder / "service.toml", toml);
        return loadConfig(folder / "service.toml");
    }
    std::string refusal(const std::string& toml) {
        try {
            load(toml);
        } catch (const InputError& e) {
            return e.what();
        }
        return "taken";
    }
};

TEST_F(ConfigTest, AnEmptyFileIsTheDefaults) {
    const Config config = load("");
    EXPECT_EQ(config.tcp.host, "127.0.0.1");
    EXPECT_EQ(config.tcp.port, 7788);
    EXPECT_EQ(config.render.scenes, folder / "scenes");
    EXPECT_TRUE(config.unixSocket.empty());
}

TEST_F(ConfigTest, TheShippedFileIsGood) {
    const Config config = loadConfig(LUMULUS_CONFIGS "/service.toml");
    EXPECT_EQ(config.render.defaultScene, "cumulus.toml");
    const Config defaults = load("");
    EXPECT_EQ(config.limits.messages.jsonBytes, defaults.limits.messages.jsonBytes);
    EXPECT_EQ(config.render.limits.requests.pixels, defaults.render.limits.requests.pixels);
    EXPECT_EQ(config.render.limits.uploadFolderBytes, defaults.render.limits.uploadFolderBytes);
    EXPECT_EQ(config.render.limits.photonsPerGeneration, defaults.render.limits.photonsPerGeneration);
}

TEST_F(ConfigTest, MistakesAreNamed) {
    EXPECT_NE(refusal("[listen]\ntpc = \"x\"").find("listen.tpc"), std::string::npos);
    EXPECT_NE(refusal("nonsense = 1").find("nonsense"), std::string::npos);
    EXPECT_NE(refusal("[limits]\nconnections = 0").find("service.toml:2, limits.connections"), std::string::npos);
    EXPECT_NE(refusal("[limits]\nconnections = 1.5").find("whole"), std::string::npos);
    EXPECT_NE(refusal("[limits]\nhello_seconds = nan").find("hello_seconds"), std::string::npos);
    EXPECT_NE(refusal("[listen]\ntcp = 7").find("listen.tcp"), std::string::npos);
    EXPECT_NE(refusal("[listen]\nunix_mode = \"rw\"").find("octal"), std::string::npos);
    EXPECT_NE(refusal("[listen]\ntcp = \"\"\nhttp = \"\"").find("nothing to listen on"), std::string::npos);
    EXPECT_NE(refusal("[scenes]\nfolder = \"elsewhere\"").find("no folder"), std::string::npos);
    EXPECT_NE(refusal("[scenes]\nquality = \"best\"").find("quality"), std::string::npos);
    EXPECT_NE(refusal("[listen\n").find("service.toml:1"), std::string::npos);
}

TEST_F(ConfigTest, AddressesAreNumbers) {
    EXPECT_EQ(parseAddress("[::1]:80", "").host, "::1");
    EXPECT_EQ(parseAddress("0.0.0.0:65535", "").port, 65535);
    for (const char* bad : {"", "localhost:80", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1",
                            "127.0.0.1:8x", "1.2.3:80", ":80"})
        EXPECT_THROW(parseAddress(bad, ""), InputError) << bad;
    EXPECT_TRUE(parseAddress("127.5.0.1:1", "").loopback());
    EXPECT_FALSE(parseAddress("0.0.0.0:1", "").loopback());
}

TEST_F(ConfigTest, BeyondLoopbackOnlyWithAToken) {
    for (const char* key : {"tcp", "http"})
        EXPECT_NE(refusal("[listen]\n" + std::string(key) + " = \"0.0.0.0:0\"").find("there is no token"),
                  std::string::npos);
    const std::string open = "[listen]\ntcp = \"0.0.0.0:0\"\n[security]\ntoken_file = \"token\"";
    EXPECT_NE(refusal(open).find("token file"), std::string::npos);
    test::writeAll(folder / "token", "short\n");
    EXPECT_NE(refusal(open).find("shorter"), std::string::npos);
    test::writeAll(folder / "token", "0123456789abcdef\n");
    EXPECT_EQ(load(open).token, "0123456789abcdef");
}

}  // namespace
}  // namespace lumulus::service
