// Which clouds another density is for, and what becomes of one that is asked for while it is prepared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "service/render/density_desk.h"
#include "service/render/density_source.h"
#include "service/values/request_error.h"
#include "support/temporary_folder.h"

namespace lumulus::service {
namespace {

using testing::ElementsAre;

NewDensity ofFrame(double frame) {
    NewDensity density;
    density.frame = frame;
    return density;
}

NewDensity ofUpload(const std::string& hash) {
    NewDensity density;
    density.vdb = hash;
    return density;
}

template <class Work>
std::string refusal(const Work& work) {
    try {
        work();
    } catch (const RequestError& e) {
        return e.code + ": " + e.where;
    }
    return "taken";
}

/// A ball, and two clouds of files.
scene::Scene threeClouds() {
    scene::Scene scene;
    scene.clouds.resize(3);
    scene.clouds[1].name = "east";
    scene.clouds[2].name = "west";
    for (const std::size_t i : {1U, 2U}) {
        scene.clouds[i].vdb = "/scenes/a_0000.vdb";
        scene.clouds[i].moment = scene::SequenceMoment{"/scenes/a_####.vdb", 0.0, 24.0, {}};
    }
    return scene;
}

TEST(Density, IsForTheCloudThatIsNamedOrTheOnlyOne) {
    const scene::Scene scene = threeClouds();
    const std::string hash(64, 'a');
    EXPECT_THAT(cloudsOfDensity(scene, ofUpload(hash), CloudReference("east")), ElementsAre(1));
    EXPECT_THAT(cloudsOfDensity(scene, ofUpload(hash), CloudReference(0U)), ElementsAre(0));
    EXPECT_THAT(cloudsOfDensity(scene, ofFrame(3.0), std::nullopt), ElementsAre()) << "those that the file says";
    EXPECT_THAT(cloudsOfDensity(scene, ofFrame(3.0), CloudReference("west")), ElementsAre(2));
    const auto refused = [&](const scene::Scene& of, const NewDensity& density, std::optional<CloudReference> cloud) {
        return refusal([&] { cloudsOfDensity(of, density, cloud); });
    };
    EXPECT_EQ(refused(scene, ofUpload(hash), std::nullopt), "bad_request: cloud") << "which of three?";
    EXPECT_EQ(refused(scene, ofUpload(hash), CloudReference("north")), "not_found: cloud");
    EXPECT_EQ(refused({}, ofUpload(hash), std::nullopt), "not_found: cloud");
    scene::Scene one;
    one.clouds.resize(1);
    EXPECT_THAT(cloudsOfDensity(one, ofUpload(hash), std::nullopt), ElementsAre(0));
}

/// A folder with a scene of the files 0 and 1, whose second cloud is there from file 1 on.
class DensitySource : public testing::Test {
  protected:
    DensitySource() {
        config.scenes = folder / "scenes";
        config.uploads = folder / "uploads";
        std::filesystem::create_directories(config.scenes);
        std::filesystem::create_directories(config.uploads);
        for (const char* name : {"a_0000.vdb", "a_0001.vdb"}) std::ofstream(config.scenes / name) << "x";
        LoadScene load;
        load.toml = R"(
[[cloud]]
name = "always"
vdb = "a_####.vdb"
extinction = 0.5
[[cloud]]
name = "later"
vdb = "a_####.vdb"
frames = [1, 1]
extend = "clip"
extinction = 0.25
[[cloud]]
procedural = "sphere"
)";
        wish.shown = sourceScene(load, config, 1);
    }
    SourcedScene source() { return sourceDensity(wish, config, 1, 7); }

    test::TemporaryFolder folder;
    RenderConfig config;
    DensityWish wish;
};

TEST_F(DensitySource, AFrameIsWhatTheFileSaysOfIt) {
    ASSERT_EQ(wish.shown.scene.clouds[1].extinction, 0.0) << "it is not there yet";
    wish.density = ofFrame(1.0);                   // of all clouds
    wish.shown.scene.clouds[0].extinction = 0.75;  // as an edit has left it
    SourcedScene found = source();
    for (const std::size_t i : {0U, 1U}) EXPECT_EQ(found.scene.clouds[i].vdb.filename(), "a_0001.vdb");
    EXPECT_EQ(found.scene.clouds[2], wish.shown.scene.clouds[2]) << "a ball has no frames";
    EXPECT_EQ(found.scene.clouds[0].extinction, 0.75);
    EXPECT_EQ(found.scene.clouds[1].extinction, 0.25) << "now it is there";
    EXPECT_NE(found.key, wish.shown.key) << "nobody else sees it";
    const std::vector<CloudShown> shown = cloudsShown(found.scene, wish);
    ASSERT_EQ(shown.size(), 2U);
    EXPECT_EQ(shown.at(1).name, "later");
    EXPECT_EQ(shown.at(1).file, 1.0);
    wish.shown = found;
    wish.density = ofFrame(0.0);
    EXPECT_EQ(source().scene.clouds[1].extinction, 0.0) << "and goes again";
    wish.density = ofFrame(2.0);
    EXPECT_EQ(refusal([&] { source(); }), "bad_request: frame") << "a file that is not there";
    wish.density = ofFrame(1.0);
    wish.clouds = {2};
    EXPECT_EQ(refusal([&] { source(); }), "bad_request: cloud");
}

TEST_F(DensitySource, AnAddedCloudHasTheFramesOfTheOneThatItIsLike) {
    wish.shown.scene.clouds.push_back(wish.shown.scene.clouds[0]);
    wish.shown.scene.clouds.back().name = "added";
    wish.clouds = {3};
    wish.density = ofFrame(1.0);
    EXPECT_EQ(source().scene.clouds[3].vdb.filename(), "a_0001.vdb");
    wish.shown.scene.clouds.back().moment.reset();
    EXPECT_EQ(refusal([&] { source(); }), "bad_request: cloud");
}

TEST_F(DensitySource, AnUploadHasToBeHere) {
    const std::string hash(64, 'b');
    wish.clouds = {0};
    wish.density = ofUpload(hash);
    wish.density.grid = "smoke";
    EXPECT_EQ(refusal([&] { source(); }), "not_found: vdb");
    std::ofstream(config.uploads / (hash + ".vdb")) << "x";
    const scene::Scene found = source().scene;
    EXPECT_EQ(found.clouds[0].vdb.stem(), hash);
    EXPECT_EQ(found.clouds[0].grid, "smoke");
    EXPECT_FALSE(found.clouds[0].moment);
    EXPECT_EQ(found.clouds[1], wish.shown.scene.clouds[1]);
    EXPECT_EQ(cloudsShown(found, wish).at(0).vdb, hash);
    wish.shown.scene = found;
    wish.density = ofFrame(1.0);
    EXPECT_EQ(source().scene.clouds[0].vdb.filename(), "a_0001.vdb") << "frames come back";
}

/// Loaders and the render thread meet where no client sees a scene.
class DensityDeskTest : public testing::Test {
  protected:
    LoadJob jobOf(ClientId client, std::uint64_t id) {
        return {client, id, {}, {}, std::make_shared<const DensityWish>()};
    }

    std::mutex mutex;
    Instruments instruments{1000};
    SceneStore scenes{1, 1};
    std::vector<std::string> replies;  // "client id code"
    DensityDesk desk{instruments,
                     {mutex, scenes,
                      [this](ClientId client, std::uint64_t id, const Reply& reply) {
                          const auto* failure = std::get_if<Failure>(&reply);
                          replies.push_back(std::to_string(client) + " " + std::to_string(id) + " " +
                                            (failure != nullptr ? failure->code : "shown"));
                      },
                      [] {}, [](const SceneSlot&) { return 0.0; }}};
};

TEST_F(DensityDeskTest, WhoHasNoSceneAnyMoreIsTold) {
    std::string code;
    std::thread loader([&] { code = refusal([&] { desk.before(jobOf(1, 5), [] {}); }); });
    while (true) {
        const std::lock_guard lock(mutex);
        if (desk.any()) break;
    }
    desk.work();
    loader.join();
    EXPECT_EQ(code, "no_scene: ");
    EXPECT_FALSE(desk.any());
    desk.add(jobOf(1, 6), nullptr, {});
    desk.work();
    EXPECT_THAT(replies, ElementsAre("1 6 no_scene"));
    EXPECT_FALSE(desk.any());
}

TEST_F(DensityDeskTest, WhatIsGivenUpIsForgotten) {
    EXPECT_THROW(desk.before(jobOf(1, 5), [] { throw Cancelled{}; }), Cancelled);
    EXPECT_FALSE(desk.any()) << "nobody answers who does not wait";
    for (const ClientId client : {1U, 2U, 1U}) desk.add(jobOf(client, 10 + client), nullptr, {});
    std::vector<LoadJob> jobs = desk.take(1);
    ASSERT_EQ(jobs.size(), 2U);
    EXPECT_EQ(jobs[1].id, 11U);
    EXPECT_TRUE(desk.any());
    desk.removeClient(2);
    EXPECT_FALSE(desk.any());
    EXPECT_TRUE(desk.takeAll().empty());
    EXPECT_TRUE(replies.empty());
    EXPECT_EQ(scenes.takeRetired().size(), 3U) << "they end where scenes do";
}

}  // namespace
}  // namespace lumulus::service
