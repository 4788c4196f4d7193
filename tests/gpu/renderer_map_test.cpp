// A renderer under a map of the surroundings: what it records, and light against known answers and the reference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/exr.h"
#include "reference/render.h"
#include "render/renderer.h"
#include "sky/environment.h"
#include "support/painted_map.h"
#include "support/small_scene.h"
#include "support/temporary_folder.h"
#include "view/camera.h"
#include "volume/load.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const char* const names[3] = {"R", "G", "B"};

dvec3 gradient(const dvec3& d) {
    return dvec3(0.3, 0.4, 0.6) + 0.25 * d.x + dvec3(0.0, 0.1, 0.3) * d.y;
}

/// A disc of 3.4° that is a thousand times as bright.
dvec3 withPatch(const dvec3& d) {
    return gradient(d) + (glm::dot(d, scene::skyDirection(60.0, 35.0)) > std::cos(0.03) ? dvec3(400.0) : dvec3(0.0));
}

class RendererMap : public testing::Test {
  protected:
    scene::Scene sceneUnder(int width, const test::Paint& paint) {
        scene::Scene scene = test::smallScene();
        scene.sky.model = scene::SkyModel::map;
        scene.sky.map = folder_.path() / "sky.exr";
        scene.sun.irradiance = dvec3(0.0);
        writeExr(scene.sky.map, test::painted(width, paint));
        return scene;
    }

    test::TemporaryFolder folder_;
};

TEST_F(RendererMap, RecordsItsPassAndAConstantSkyDoesNot) {
    const Frame frame = test::render(sceneUnder(64, gradient));
    EXPECT_THAT(frame.passes(), Contains("frame sky map"));
    EXPECT_THAT(test::render(test::smallScene()).passes(), Not(Contains("frame sky map")));
    for (const auto& [name, values] : frame.image.layers)
        for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
}

/// Pixels beside the cloud have the map's radiance, in all projections, across its edge too.
TEST_F(RendererMap, PixelsShowTheMap) {
    scene::Scene scene = sceneUnder(128, gradient);
    scene.sky.mapRotation = 40.0;
    const sky::Environment environment(scene.sky);
    for (const auto projection : {scene::Projection::perspective, scene::Projection::panorama}) {
        scene.camera.projection = projection;
        scene.camera.position = dvec3(0.0, 60.0, -2000.0);
        scene.camera.target = dvec3(100.0, 100.0, -3000.0);
        scene.camera.verticalFov = 90.0;
        const Frame frame = test::render(scene);
        const Camera camera = makeCamera(scene.camera, scene.image, Bounds{});
        for (int y = 0; y < scene.image.height; ++y)
            for (int x = 0; x < scene.image.width; ++x) {
                const auto i = static_cast<std::size_t>(y * scene.image.width + x);
                if (frame.image.layers.at("cloud.A")[i] > 0.0F) continue;
                const dvec3 expected = environment.radiance({}, camera.ray(x + 0.5, y + 0.5).direction, scene.sun);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(static_cast<double>(frame.image.layers.at(names[c])[i]), expected[c], 0.012)
                        << x << " " << y;
            }
    }
}

/// A map that is the same everywhere is a constant sky: the picture but for the photons' noise, the sky exactly.
TEST_F(RendererMap, AUniformMapIsAConstantSky) {
    const dvec3 radiance(0.12, 0.22, 0.42);
    scene::Scene scene = sceneUnder(32, [&](const dvec3&) { return radiance; });
    scene.photonMap.photons = 100000;
    const Frame map = test::render(scene);
    scene.sky.model = scene::SkyModel::constant;
    scene.sky.radiance = radiance;
    const Frame constant = test::render(scene);
    double sum = 0.0, difference = 0.0, square = 0.0, squares = 0.0;
    const auto &a = map.image.layers.at("G"), &b = constant.image.layers.at("G");
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (b[i] == static_cast<float>(radiance.y)) {
            EXPECT_NEAR(a[i], b[i], 1e-6F) << i;
        }
        const auto apart = static_cast<double>(a[i] - b[i]), value = static_cast<double>(b[i]);
        sum += value, difference += apart;
        squares += value * value, square += apart * apart;
    }
    EXPECT_LT(std::abs(difference), 0.003 * sum);
    EXPECT_LT(square, std::pow(0.03, 2) * squares) << "noise of both";
}

LayeredImage pathTraced(const scene::Scene& scene, int samples) {
    const CloudVolumes volumes = loadClouds(
        scene, noReport, [] {}, FieldStorage::dense);
    reference::Renderer renderer(scene, volumes.placed(), reference::Majorant::local, 5);
    for (int i = 0; i < samples; ++i) renderer.pass([](std::uint64_t) { return true; });
    return renderer.picture();
}

/// Mean square and mean of the error of the cloud's pixels against the path tracer, without the latter's noise.
void compareWithReference(const scene::Scene& scene, bool sunFound) {
    Renderer renderer(scene, {.device = "", .validation = true});
    EXPECT_EQ(renderer.sun().irradiance != dvec3(0.0), sunFound);
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    const LayeredImage image = renderer.draw();
    const LayeredImage truth = pathTraced(scene, 256);
    double error = 0.0, squares = 0.0, sum = 0.0, expected = 0.0, noise = 0.0;
    for (int c = 0; c < 3; ++c) {
        const auto &seen = image.layers.at(names[c]), &exact = truth.layers.at(names[c]);
        const auto& variance = truth.layers.at(std::string("variance.") + names[c]);
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if (truth.layers.at("cloud.A")[i] < 0.05F) continue;
            const auto s = static_cast<double>(seen[i]), e = static_cast<double>(exact[i]);
            error += (s - e) * (s - e) - static_cast<double>(variance[i]);
            squares += e * e;
            sum += s, expected += e, noise += static_cast<double>(variance[i]);
        }
    }
    EXPECT_LT(error, 2e-3 * squares);
    EXPECT_NEAR(sum, expected, 0.01 * expected + 3.0 * std::sqrt(noise));
}

TEST_F(RendererMap, CloudsAreLitAsByTheReference) {
    scene::Scene scene = sceneUnder(128, gradient);
    scene.photonMap = scene::PhotonMap{};
    scene.photonMap.photons = 200000;
    compareWithReference(scene, false);
    scene = sceneUnder(512, withPatch);
    scene.photonMap = scene::PhotonMap{};
    scene.photonMap.photons = 200000;
    compareWithReference(scene, true);
}

/// Several clouds have one table of the map among them.
TEST_F(RendererMap, TwoCloudsAreLitAsByTheReference) {
    scene::Scene scene = sceneUnder(256, withPatch);
    scene.photonMap.photons = 300000;
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[1].transform[3] = glm::dvec4(150.0, 40.0, 60.0, 1.0);
    compareWithReference(scene, true);
}

TEST_F(RendererMap, ItsSunCannotMoveAndAGroundIsRefused) {
    scene::Scene scene = sceneUnder(256, withPatch);
    Renderer renderer(scene, {.device = "", .validation = true});
    EXPECT_THROW(renderer.setSun({0.0, 1.0, 0.0}, dvec3(1.0)), InputError);
    scene.ground.emplace();
    try {
        const Renderer refused(scene, {.device = "", .validation = true});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("ground"));
    }
}

}  // namespace
}  // namespace lumulus
