#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "lamp/air.h"
#include "lamp/lamp_picture.h"
#include "medium/scattering_tables.h"
#include "query/bricks.h"
#include "reference/render.h"
#include "scene/load.h"
#include "stat/picture_distance.h"
#include "view/camera.h"
#include "volume/load.h"

// Pictures of lamps among clouds against those of the path tracer.
namespace lumulus {
namespace {

// A ball of 200 m above the ground.
const std::string around = R"(
[image]
width = 48
height = 32
[camera]
position = [0, 10, 600]
target = [0, 260, 0]
vertical_fov = 30
[sun]
irradiance = 0.0
[sky]
model = "constant"
radiance = 0.0
[ground]
height = 0.0
albedo = 0.2
)";

std::string ball(double extinction) {
    return "[[cloud]]\nprocedural = \"sphere\"\nresolution = 48\nphase.g = 0.5\nextinction = " +
           std::to_string(extinction) + "\ntransform = [[1, 0, 0, 0], [0, 1, 0, 160], [0, 0, 1, 0]]\n";
}

const std::string fog = R"(
[[fog.media]]
scattering = [0.0008, 0.001, 0.0012]
absorption = 0.0001
g = 0.6
bottom = 0
top = 130
)";

const std::string searchlight = R"(
[[lamp]]
kind = "spot"
position = [-60, 2, 20]
target = [0, 260, 0]
angle = 24
softness = 0.5
radius = 1.0
power = [900, 1000, 800]
)";

const std::string lantern = R"(
[[lamp]]
position = [40, 300, 10]
radius = 1.0
power = [900, 1000, 800]
)";

struct Case {
    scene::Scene scene;
    CloudVolumes volumes;

    explicit Case(const std::string& text) : scene(scene::parseScene(text, "x.toml")), volumes(loadClouds(scene)) {}

    std::vector<lamp::Cloud> clouds() const {
        std::vector<lamp::Cloud> all;
        for (std::size_t i = 0; i < volumes.clouds.size(); ++i) {
            const CloudVolumes::Cloud& cloud = volumes.clouds[i];
            const scene::Cloud& of = scene.clouds[i];
            auto field = std::make_shared<const query::BrickField>(*volumes.volumes[cloud.volume]);
            all.push_back({{field, cloud.toWorld.linear, cloud.toWorld.translation, of.extinction * of.densityScale},
                           of.albedo,
                           lamp::CloudPhase(phase::makeScatteringTables(of.phase, 0.0, of.albedo, 1, 0.0))});
        }
        return all;
    }

    LayeredImage drawn(int paths) const {
        LayeredImage image;
        image.width = scene.image.width;
        image.height = scene.image.height;
        for (const char* name : {"R", "G", "B"}) image.layer(name);
        const Camera camera = makeCamera(scene.camera, scene.image, {});
        const bool air = scene.sky.model == scene::SkyModel::atmosphere;
        const scene::Fog haze = air ? lamp::withAir(scene.fog, sky::airOf(scene.sky), scene.ground->height) : scene.fog;
        lamp::addLamps(image, camera, {0, 0, image.width, image.height},
                       {scene.lamps, haze, scene.ground, paths, 1, clouds()}, stopIfInterrupted);
        return image;
    }

    LayeredImage truth(int samples, int scatterings) const {
        reference::Renderer renderer(scene, volumes.placed(), reference::Majorant::local, 5, scatterings);
        for (int i = 0; i < samples; ++i) renderer.pass([](std::uint64_t) { return true; });
        return renderer.picture();
    }
};

using test::Distance;
using test::distanceOf;

Distance once(const std::string& text, int samples) {
    const Case one(around + text);
    return distanceOf(one.drawn(0), one.truth(samples, 1));
}

Distance all(const std::string& text, int samples, const std::string& size = "width = 48\nheight = 32") {
    std::string scene = around + text;
    scene.replace(scene.find("width"), scene.find("[camera]") - scene.find("width"), size + "\n");
    const Case one(scene);
    return distanceOf(one.drawn(1'000'000), one.truth(samples, reference::allScatterings));
}

/// Bounds: those of the issue, and what the reference's own noise may add (three standard errors of the sum).
void expectNear(const Distance& found, double relative = 1e-2) {
    EXPECT_LT(std::abs(found.bias), 0.02 + 3.0 * found.noise);
    EXPECT_LT(std::abs(found.relative), relative);
}

TEST(LampsAndClouds, ASearchlightScattersOnceInACloud) {
    expectNear(once(ball(0.03) + searchlight, 2000));
}

TEST(LampsAndClouds, ASearchlightScattersOnceInFogAndACloud) {
    expectNear(once(ball(0.03) + fog + searchlight, 2000));
}

TEST(LampsAndClouds, ALampWithinAThinCloudScattersOnce) {
    expectNear(once(ball(0.004) + lantern, 1000));
}

TEST(LampsAndClouds, ASearchlightBelowACloud) {
    expectNear(all(ball(0.012) + searchlight, 4000));
}

/// Large pixels and a wider bound: few of the reference's paths meet what the fog scatters of the cloud's light.
TEST(LampsAndClouds, ASearchlightInFogBelowACloud) {
    expectNear(all(ball(0.012) + fog + searchlight, 60'000, "width = 12\nheight = 8"), 5e-2);
}

/// At night, with light that the air takes and scatters, which few of the reference's paths meet.
TEST(LampsAndClouds, ASearchlightBelowACloudInAnAtmosphere) {
    std::string text = around;
    text.replace(text.find("model = \"constant\"\nradiance = 0.0"), 33, "model = \"atmosphere\"");
    text.replace(text.find("width"), text.find("[camera]") - text.find("width"), "width = 12\nheight = 8\n");
    const Case one(text + ball(0.012) + searchlight);
    expectNear(distanceOf(one.drawn(1'000'000), one.truth(20'000, reference::allScatterings)), 5e-2);
}

TEST(LampsAndClouds, ALampWithinAThinCloud) {
    expectNear(all(ball(0.004) + lantern, 4000));
}

/// The ground behind an opaque cloud is as dark as without a lamp: the cloud hides the lamp and what it lights.
TEST(LampsAndClouds, AnOpaqueCloudHidesALampAndItsGround) {
    const std::string camera = R"(
[camera]
position = [0, 260, 600]
target = [0, 260, 0]
vertical_fov = 1
)";
    std::string text = around;
    text.replace(text.find("[camera]"), text.find("[sun]") - text.find("[camera]"), camera);
    const Case one(text + ball(100.0) + R"(
[[lamp]]
position = [0, 260, -400]
power = 1e6
)");
    const LayeredImage image = one.drawn(0);
    for (const float value : image.layers.at("G")) ASSERT_EQ(value, 0.0F);
}

/// Finite light where a lamp is in an opaque cloud, where the eye is in it too, and where both are in its side.
TEST(LampsAndClouds, IsFiniteEverywhere) {
    for (const char* eye : {"[0, 255, 2]", "[0, 260, 97]", "[0, 10, 600]"}) {
        std::string text = around;
        text.replace(text.find("[0, 10, 600]"), 12, eye);
        const Case one(text + ball(10.0) + fog + R"(
[[lamp]]
position = [0, 260, 0]
power = 1000
[[lamp]]
position = [0, 260, 100]
radius = 0.5
power = 1000
[[lamp]]
kind = "spot"
position = [0, 260, 98.8]
direction = [0, 0, -1]
angle = 180
power = 1000
[[lamp]]
kind = "spot"
position = [0, 400, 0]
direction = [0, -1, 0]
angle = 0.001
power = 1000
)");
        const LayeredImage image = one.drawn(50);
        for (const char* name : {"R", "G", "B"})
            for (const float value : image.layers.at(name)) ASSERT_TRUE(std::isfinite(value) && value >= 0.0F) << eye;
    }
}

}  // namespace
}  // namespace lumulus
