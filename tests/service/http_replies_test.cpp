// The answers of the HTTP port, without sockets; and what replies tell of the server's folders.
#include "service/net/http_replies.h"

#include <gtest/gtest.h>

#include <cstring>
#include <span>

#include "service/render/client_picture.h"
#include "service/render/server_paths.h"
#include "service/values/request_error.h"
#include "support/temporary_folder.h"

namespace lumulus::service {
namespace {

HttpQuestion question(std::string_view target, std::size_t hosts = 1, bool oldVersion = false) {
    HttpQuestion result;
    result.target = target;
    result.hosts = hosts;
    result.oldVersion = oldVersion;
    if (hosts > 0) result.host = "localhost:7789";
    return result;
}

TEST(HttpReplies, HealthIsAliveAndReadyIsMore) {
    const Metrics metrics;
    EXPECT_EQ(httpReply(question("/health"), std::nullopt, metrics).body, "ok\n");
    EXPECT_EQ(httpReply(question("/health"), "the default scene is being loaded", metrics).status, 200);
    EXPECT_EQ(httpReply(question("/ready"), std::nullopt, metrics).status, 200);
    const HttpReply notReady = httpReply(question("/ready"), "the default scene is being loaded", metrics);
    EXPECT_EQ(notReady.status, 503);
    EXPECT_EQ(notReady.body, "the default scene is being loaded\n");
    EXPECT_EQ(httpReply(question("/absent"), std::nullopt, metrics).status, 404);
}

TEST(HttpReplies, OneHostFieldOrNoneWhereThatIsAllowed) {
    for (const char* target : {"/", "/health", "/metrics"}) EXPECT_EQ(malformed(question(target, 2))->status, 400);
    EXPECT_EQ(malformed(question("/", 0))->status, 400);
    EXPECT_FALSE(malformed(question("/", 0, true)));
    EXPECT_FALSE(malformed(question("/health", 0, true)));
    EXPECT_FALSE(malformed(question("/ready?x", 0)));
    EXPECT_FALSE(malformed(question("/")));
}

TEST(HttpReplies, ProbesNeedNoKnownName) {
    const Config config;
    HttpQuestion other = question("/health");
    other.host = "balancer.example";
    EXPECT_TRUE(hostAllowed(other, config));
    other.target = "/";
    EXPECT_FALSE(hostAllowed(other, config));
    EXPECT_TRUE(hostAllowed(question("/ready", 0, true), config));
    EXPECT_FALSE(hostAllowed(question("/metrics", 0, true), config));
}

TEST(ServerPaths, RepliesNameFilesAsClientsDo) {
    RenderConfig config;
    config.scenes = "/srv/lumulus/scenes";
    config.uploads = "/srv/lumulus/uploads";
    const ServerPaths paths(config);
    const std::string hash(64, 'a');
    EXPECT_EQ(paths.hidden("bad voxels (/srv/lumulus/uploads/" + hash + ".vdb): mend it"),
              "bad voxels (upload sha256:" + hash + "): mend it");
    EXPECT_EQ(paths.hidden("/srv/lumulus/scenes/a/b.toml:3, cloud.0"), "a/b.toml:3, cloud.0");
    EXPECT_EQ(paths.hidden("/srv/lumulus/uploads/"), "upload sha256:");
    EXPECT_EQ(paths.hidden("nothing to hide"), "nothing to hide");
    Reply reply = Failure{"bad_request", "see /srv/lumulus/scenes/x.vdb", {}};
    paths.hide(reply);
    EXPECT_EQ(std::get<Failure>(reply).text, "see x.vdb");
    SceneDescription scene;
    scene.warnings = {"/srv/lumulus/uploads/" + hash + ".vdb has two grids"};
    reply = scene;
    paths.hide(reply);
    EXPECT_EQ(std::get<SceneDescription>(reply).warnings[0], "upload sha256:" + hash + " has two grids");
}

TEST(ServerPaths, LinksToTheFoldersAreHiddenToo) {
    const lumulus::test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "real");
    std::filesystem::create_directory_symlink(folder / "real", folder / "link");
    RenderConfig config;
    config.scenes = folder / "link";
    const ServerPaths paths(config);
    EXPECT_EQ(paths.hidden((folder / "real" / "a.vdb").string() + " or " + (folder / "link" / "a.vdb").string()),
              "a.vdb or a.vdb");
}

TEST(ClientPicture, IsColourThenDepth) {
    Composite composite;
    composite.width = 2;
    composite.height = 1;
    const std::vector<float> values{1, 2, 3, 4, 5, 6, 70, 80};
    const auto bytes = std::as_bytes(std::span(values));
    composite.pixels.assign(bytes.begin(), bytes.end());
    LayeredImage picture;
    EXPECT_EQ(readPixels(composite, picture), (std::vector<float>{70, 80}));
    EXPECT_EQ(picture.layer("G"), (std::vector<float>{2, 5}));
    const std::uint32_t infinity = 0x7F800000U;
    std::memcpy(composite.pixels.data() + 28, &infinity, 4);
    EXPECT_THROW(readPixels(composite, picture), RequestError);
}

}  // namespace
}  // namespace lumulus::service
