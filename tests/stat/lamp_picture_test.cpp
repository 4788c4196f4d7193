#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "lamp/lamp_picture.h"
#include "reference/render.h"
#include "scene/load.h"
#include "stat/picture_distance.h"
#include "view/camera.h"

// Pictures of lamps in fog against those of the path tracer.
namespace lumulus {
namespace {

const std::string around = R"(
cloud = []
[image]
width = 48
height = 32
[camera]
position = [0, 10, 0]
target = [0, 10, -100]
vertical_fov = 50
[sun]
irradiance = 0.0
[sky]
model = "constant"
radiance = 0.0
[ground]
height = 0.0
albedo = 0.2
[[fog.media]]
scattering = [0.008, 0.01, 0.012]
absorption = 0.001
g = 0.6
bottom = 0
top = 60
)";

const std::string pointLamp = R"(
[[lamp]]
position = [6, 14, -60]
radius = 0.3
power = [800, 700, 500]
)";

const std::string beams = R"(
[[lamp]]
kind = "spot"
position = [-30, 12, -80]
target = [20, 25, -65]
angle = 60
softness = 0.4
radius = 0.8
power = 800
[[lamp]]
kind = "pyramid"
position = [10, 20, -60]
target = [5, 0, -70]
angle = 50
radius = 0.8
power = [100, 300, 600]
)";

LayeredImage drawn(const scene::Scene& scene, int paths) {
    LayeredImage image;
    image.width = scene.image.width;
    image.height = scene.image.height;
    for (const char* name : {"R", "G", "B"}) image.layer(name);
    const Camera camera = makeCamera(scene.camera, scene.image, {});
    lamp::addLamps(image, camera, {0, 0, image.width, image.height}, {scene.lamps, scene.fog, scene.ground, paths, 1},
                   stopIfInterrupted);
    return image;
}

/// Light is a sum: a picture of all lamps is that of each alone, where nothing is left out and no group stands for its
/// lamps. Without discs, which hide each other.
LayeredImage drawnOneByOne(const scene::Scene& scene) {
    LayeredImage image;
    image.width = scene.image.width;
    image.height = scene.image.height;
    for (const char* name : {"R", "G", "B"}) image.layer(name);
    const Camera camera = makeCamera(scene.camera, scene.image, {});
    for (const scene::Lamp& lamp : scene.lamps) {
        const std::vector<scene::Lamp> alone{lamp};
        lamp::Surroundings open{alone, scene.fog, scene.ground};
        open.discs = false;
        lamp::addLamps(image, camera, {0, 0, image.width, image.height}, open, stopIfInterrupted);
    }
    return image;
}

LayeredImage truth(const scene::Scene& scene, int samples, int scatterings) {
    reference::Renderer renderer(scene, {}, reference::Majorant::global, 5, scatterings);
    for (int i = 0; i < samples; ++i) renderer.pass([](std::uint64_t) { return true; });
    return renderer.picture();
}

using test::Distance;
using test::distanceOf;

Distance compared(const std::string& lamps, int samples, int scatterings, int paths) {
    const scene::Scene scene = scene::parseScene(around + lamps, "x.toml");
    const Distance found = distanceOf(drawn(scene, paths), truth(scene, samples, scatterings));
    return found;
}

TEST(LampPicture, APointScattersOnce) {
    const Distance found = compared(pointLamp, 400, 1, 0);
    EXPECT_LT(std::abs(found.bias), 0.01);
    EXPECT_LT(std::abs(found.relative), 1e-4);
}

TEST(LampPicture, APanoramaHasLampsAllAround) {
    std::string text =
        around + pointLamp + "[[lamp]]\nposition = [-20, 24, 50]\nradius = 0.3\npower = [200, 700, 500]\n";
    text.replace(text.find("vertical_fov = 50"), 17, "projection = \"panorama\"");
    const scene::Scene scene = scene::parseScene(text, "x.toml");
    const Distance found = distanceOf(drawn(scene, 0), truth(scene, 1500, 1));
    EXPECT_LT(std::abs(found.bias), 0.02);
    EXPECT_LT(std::abs(found.relative), 1e-3);
}

/// Of the error, most is noise of the reference beside the lamps, which few of its paths meet.
TEST(LampPicture, BeamsScatterOnce) {
    const Distance found = compared(beams, 2000, 1, 0);
    EXPECT_LT(std::abs(found.bias), 0.03);
    EXPECT_LT(std::abs(found.relative), 3e-2);
}

TEST(LampPicture, APointWithAllScatterings) {
    const Distance found = compared(pointLamp, 1500, reference::allScatterings, 2'000'000);
    EXPECT_LT(std::abs(found.bias), 0.03);
    EXPECT_LT(std::abs(found.relative), 3e-2);
}

/// 300 lamps of three kinds, most of them beside the picture or far away. Groups and interpolation of faint light
/// change it less than 0.5 %, and no pixel by more than 8 % (at the horizon, where pixels are coarse).
TEST(LampPicture, ManyLampsAreTheSumOfEach) {
    scene::Scene scene = scene::parseScene(around, "x.toml");
    for (int i = 0; i < 300; ++i) {
        scene::Lamp& lamp = scene.lamps.emplace_back();
        const double angle = 2.4 * i, away = 30.0 + 60.0 * std::sqrt(i);  // a spiral
        lamp.kind = i % 3 == 0 ? scene::LampKind::spot : scene::LampKind::point;
        lamp.position = {away * std::sin(angle), 4.0 + i % 7, -away * std::cos(angle)};
        lamp.direction = i % 2 == 0 ? glm::dvec3(0.0, -1.0, 0.0) : glm::dvec3(0.6, -0.8, 0.0);
        lamp.angle = 70.0;
        lamp.softness = 0.3;
        lamp.power = i % 2 == 0 ? glm::dvec3(90.0, 80.0, 40.0) : glm::dvec3(50.0, 60.0, 90.0);
    }
    LayeredImage together = drawnOneByOne(scene), whole = together;
    for (const char* name : {"R", "G", "B"}) std::ranges::fill(whole.layer(name), 0.0F);
    lamp::Surroundings open{scene.lamps, scene.fog, scene.ground};
    open.discs = false;
    lamp::addLamps(whole, makeCamera(scene.camera, scene.image, {}), {0, 0, whole.width, whole.height}, open,
                   stopIfInterrupted);
    for (const char* name : {"variance.R", "variance.G", "variance.B"}) together.layer(name);  // it has none
    const Distance found = distanceOf(whole, together);
    EXPECT_LT(std::abs(found.bias), 0.005);
    EXPECT_LT(std::abs(found.relative), 1e-4);
    for (const char* name : {"R", "G", "B"})
        for (std::size_t i = 0; i < whole.layers.at(name).size(); ++i)
            ASSERT_NEAR(whole.layers.at(name)[i] / together.layers.at(name)[i], 1.0, 0.08) << name << i;
}

/// What should not be near each other still has finite light: a lamp on the ground, one in it, the eye within a beam of
/// half of all directions, a lamp behind the eye.
TEST(LampPicture, IsFiniteEverywhere) {
    const std::string lamps = R"(
[[lamp]]
position = [3, 0, -20]
power = 10
[[lamp]]
position = [0, -5, -20]
power = 1000
[[lamp]]
kind = "spot"
position = [0, 10, -0.2]
direction = [0, 0, 1]
angle = 180
power = 1000
[[lamp]]
kind = "pyramid"
position = [0, 10, 2]
direction = [0, 1, 0]
angle = 180
softness = 1
power = 10
)";
    const scene::Scene scene = scene::parseScene(around + lamps, "x.toml");
    const LayeredImage image = drawn(scene, 2000);
    for (const char* name : {"R", "G", "B"})
        for (const float value : image.layers.at(name)) ASSERT_TRUE(std::isfinite(value) && value >= 0.0F);
}

/// A part of a picture has the bits of the whole.
TEST(LampPicture, PartsHaveTheSameBits) {
    const scene::Scene scene = scene::parseScene(around + pointLamp + beams, "x.toml");
    const LayeredImage whole = drawn(scene, 2000);
    LayeredImage part;
    part.width = 13;
    part.height = 9;
    for (const char* name : {"R", "G", "B"}) part.layer(name);
    lamp::addLamps(part, makeCamera(scene.camera, scene.image, {}), {21, 11, part.width, part.height},
                   {scene.lamps, scene.fog, scene.ground, 2000, 1}, stopIfInterrupted);
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            ASSERT_EQ(part.layers.at("G")[static_cast<std::size_t>(y * part.width + x)],
                      whole.layers.at("G")[static_cast<std::size_t>((y + 11) * whole.width + x + 21)])
                << x << ", " << y;
}

}  // namespace
}  // namespace lumulus
