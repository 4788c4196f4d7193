// What one renderer of frames keeps from frame to frame, and that it changes no bit.
#include "job/frame_renderer.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load.h"
#include "support/temporary_folder.h"
#include "vdb/procedural.h"
#include "vdb/write.h"
#include "volume/place_clouds.h"

namespace lumulus::job {
namespace {

const std::string head = R"(
image = { width = 32, height = 18 }
photon_map = { photons = 8000, generations = 2 }
preparation = { samples = 400 }
)";
const std::string constantSky = "sky = { model = \"constant\" }\n";
const std::string still = R"(
[[cloud]]
resolution = 20
seed = 2
transform = [[1, 0, 0, 900], [0, 1, 0, 100], [0, 0, 1, -9000]]
)";
const std::string field = R"(
camera = { position = [0, 300, 4000], target = [0, 900, 0] }
[[field]]
area = [3000, 0, 3000]
variants = 2
resolution = 20
wind = [[0, 0, 0, 0], [2000, 60, 0, 20]]
)";
const std::string moving = R"(
[[cloud]]
resolution = 20
[animate]
"cloud.0.transform" = [[0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]], [3, [[1, 0, 0, 30], [0, 1, 0, 0], [0, 0, 1, 0]]]]
)";

struct Shown {
    LayeredImage image;
    Statistics statistics;

    double preparation() const {
        double seconds = 0.0;
        for (const AssetSummary& asset : statistics.assets)
            seconds += asset.upload + asset.majorants + asset.sampling + asset.tree + asset.collecting;
        return seconds;
    }
};

double bytes(const Shown& shown) {
    return static_cast<double>(shown.statistics.gpuBytes);
}

class FrameRendererTest : public testing::Test {
  protected:
    static constexpr int count = 4;

    std::vector<scene::Scene> scenesOf(const std::string& toml) const {
        std::vector<scene::Scene> scenes;
        for (int frame = 0; frame < count; ++frame)
            scenes.push_back(
                placeClouds(scene::parseScene(toml, (folder / "x.toml").string(), {}, std::nullopt, {}, frame)));
        return scenes;
    }
    static Shown shown(FrameRenderer& renderer, const scene::Scene& scene, int number, const scene::Scene* next) {
        Renderer& with = renderer.of(scene, number, next);
        View view;
        view.camera = scene.camera;
        view.image = scene.image;
        Shown result;
        result.image = with.draw(view);
        result.statistics = with.statistics();
        EXPECT_TRUE(result.statistics.validationMessages.empty());
        return result;
    }
    /// All frames by one renderer, each compared with that of a renderer of its own.
    std::vector<Shown> all(const std::string& toml) const {
        const std::vector<scene::Scene> scenes = scenesOf(toml);
        RendererOptions options;
        options.validation = true;
        FrameRenderer together(options);
        std::vector<Shown> result;
        for (int i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            result.push_back(shown(together, scenes[at], i, i + 1 < count ? &scenes[at + 1] : nullptr));
            FrameRenderer alone(options);
            const Shown one = shown(alone, scenes[at], i, nullptr);
            EXPECT_EQ(result.back().image.layers, one.image.layers) << "frame " << i;
            EXPECT_EQ(result.back().statistics.assets.size(), one.statistics.assets.size());
            EXPECT_EQ(result.back().statistics.collectors, one.statistics.collectors);
            if (i == 0) continue;
            EXPECT_NE(result[at].image.layers, result[at - 1].image.layers) << "frame " << i;
        }
        return result;
    }

    test::TemporaryFolder folder;
};

TEST_F(FrameRendererTest, CloudsThatMoveArePreparedOnce) {
    for (const std::string& toml : {constantSky + head + field, constantSky + head + still + moving}) {
        const std::vector<Shown> frames = all(toml);
        EXPECT_GT(frames[0].preparation(), 0.0);
        for (std::size_t i = 1; i < frames.size(); ++i) {
            EXPECT_EQ(frames[i].preparation(), 0.0) << "frame " << i;
            EXPECT_LT(bytes(frames[i]), 1.01 * bytes(frames[0])) << "memory stays flat";
        }
    }
}

/// Under an atmosphere, whose tables are kept, and with a sun that moves too.
TEST_F(FrameRendererTest, InAnAtmosphere) {
    const std::vector<Shown> frames =
        all("sky = { model = \"atmosphere\" }\n" + head + still + moving +
            "\"sun.elevation\" = [[0, 20], [3, 40]]\n\"sky.ozone\" = [[1, 300], [2, 200]]\n");
    EXPECT_EQ(frames[3].preparation(), 0.0);
}

/// Files whose densities change are prepared anew, alone and beside a cloud that stays.
TEST_F(FrameRendererTest, FilesArePreparedAnew) {
    for (int number = 0; number < count; ++number)
        vdb::write(vdb::makeCloud({"cumulus", 20, static_cast<std::uint64_t>(number) + 1}),
                   folder / ("v" + std::to_string(number) + ".vdb"));
    const std::string files = "[[cloud]]\nvdb = \"v#.vdb\"\n";
    for (const std::string& toml : {constantSky + head + files, constantSky + head + files + still}) {
        const std::vector<Shown> frames = all(toml);
        for (const Shown& frame : frames) EXPECT_GT(frame.preparation(), 0.0);
    }
}

/// What was dropped is made again, and what is asked for in more detail is another asset.
TEST_F(FrameRendererTest, CloudsThatComeBackOrComeNear) {
    const std::string seeds =
        "[animate]\n\"cloud.1.seed\" = [[0, 2], [1, 3], [2, 2]]\n\"cloud.0.extinction\" = [[0, 0.05], "
        "[3, 0.1]]\n";
    all(constantSky + head + "[[cloud]]\nresolution = 20\n" + still + seeds);
    const std::string camera = "[animate]\n\"camera.position\" = [[0, [0, 300, 9000]], [3, [500, 700, 1500]]]\n";
    const std::vector<Shown> frames = all(constantSky + head + "[[cloud]]\nresolution = 20\n" + still + camera);
    EXPECT_GT(frames[0].preparation(), 0.0);
}

const std::string bricks = constantSky + R"(
image = { width = 32, height = 18 }
photon_map = { photons = 4000, generations = 2 }
preparation = { samples = 400, storage = "sparse" }
)";
const std::string nearer = "[animate]\n\"camera.position\" = [[0, [0, 300, 9000]], [3, [500, 700, 1500]]]\n";

/// Fields in bricks, of files and procedural ones, are prepared once where all of them stay.
TEST_F(FrameRendererTest, FieldsInBricks) {
    vdb::write(vdb::makeCloud({"cumulus", 24, 1}), folder / "v.vdb");
    const std::string file = "[[cloud]]\nvdb = \"v.vdb\"\n";
    const std::string way = R"("cloud.0.transform" = [[0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]],
                              [3, [[1, 0, 0, 300], [0, 1, 0, 0], [0, 0, 1, 0]]]])";
    for (const std::string& toml : {bricks + file + still + "[animate]\n" + way, bricks + still + moving}) {
        const std::vector<Shown> frames = all(toml);
        EXPECT_GT(frames[0].preparation(), 0.0);
        for (std::size_t i = 1; i < frames.size(); ++i) {
            EXPECT_EQ(frames[i].preparation(), 0.0) << "frame " << i;
            EXPECT_LT(bytes(frames[i]), 1.01 * bytes(frames[0])) << "memory stays flat";
        }
    }
}

/// All fields in bricks are prepared anew where one of them changes, and the pictures are right where one is asked for
/// in more detail.
TEST_F(FrameRendererTest, FieldsInBricksThatChange) {
    vdb::write(vdb::makeCloud({"cumulus", 24, 1}), folder / "v.vdb");
    for (int number = 0; number < count; ++number)
        vdb::write(vdb::makeCloud({"cumulus", 24, static_cast<std::uint64_t>(number / 2) + 1}),
                   folder / ("v" + std::to_string(number) + ".vdb"));
    all(bricks + "[[cloud]]\nvdb = \"v.vdb\"\n" + still + nearer);
    const std::vector<Shown> changing = all(bricks + "[[cloud]]\nvdb = \"v#.vdb\"\n" + still + nearer);
    for (const Shown& frame : changing) EXPECT_GT(frame.preparation(), 0.0);
}

/// A frame that fails leaves nothing behind, and those after it are as they would be.
TEST_F(FrameRendererTest, AFrameThatFails) {
    vdb::write(vdb::makeCloud({"cumulus", 20, 1}), folder / "v0.vdb");
    vdb::write(vdb::makeCloud({"cumulus", 20, 2}), folder / "v2.vdb");
    test::writeAll(folder / "v1.vdb", "no grids");
    vdb::write(vdb::makeCloud({"cumulus", 20, 3}), folder / "v3.vdb");
    const std::vector<scene::Scene> scenes = scenesOf(constantSky + head + "[[cloud]]\nvdb = \"v#.vdb\"\n" + still);
    RendererOptions options;
    FrameRenderer together(options), alone(options);
    shown(together, scenes[0], 0, &scenes[1]);
    EXPECT_THROW(together.of(scenes[1], 1, &scenes[2]), InputError);
    EXPECT_EQ(shown(together, scenes[2], 2, nullptr).image.layers, shown(alone, scenes[2], 2, nullptr).image.layers);
}

}  // namespace
}  // namespace lumulus::job
