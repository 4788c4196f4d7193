// Clouds stand between each other and the sun: the first scattering of its light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

using glm::dvec3;
using test::Frame;

/// Sun alone, from above at a slant, and clouds that scatter so little that all their light has scattered once.
scene::Scene litOnce() {
    scene::Scene scene = test::smallScene();
    scene.draw.tolerance = 0.0;
    scene.image = {64, 64, 0.0};
    scene.sky.radiance = dvec3(0.0);
    scene.sun.directionTo = glm::normalize(dvec3(0.5, 1.0, 0.2));
    scene.photonMap.photons = 64;
    scene.clouds[0].albedo = dvec3(1e-3);
    scene.camera.position = dvec3(0.0, 100.0, 900.0);
    scene.camera.target = dvec3(0.0, 100.0, 0.0);
    scene.camera.verticalFov = 20.0;
    return scene;
}

scene::Cloud movedBy(scene::Cloud cloud, const dvec3& offset) {
    cloud.transform[3] = glm::dvec4(offset, 1.0);
    return cloud;
}

double meanLight(const Frame& frame) {
    double sum = 0.0;
    for (const float value : frame.image.layers.at("cloud.G")) sum += static_cast<double>(value);
    return sum / static_cast<double>(frame.image.pixels());
}

/// Half the density twice at one place, and an eighth eight times, are lit as the whole once.
TEST(SharedShadow, ExtinctionsThatOverlapAddUp) {
    scene::Scene scene = litOnce();
    const scene::Cloud whole = scene.clouds[0];
    const double once = meanLight(test::render(scene));
    for (const std::size_t parts : {2U, 8U}) {
        scene::Cloud part = whole;
        part.extinction /= static_cast<double>(parts);
        scene.clouds.assign(parts, part);
        EXPECT_NEAR(meanLight(test::render(scene)) / once, 1.0, 3e-3) << parts;
    }
}

/// A cloud in the shadow of another one that is out of the picture is dark; one before or beside the other is not.
TEST(SharedShadow, FallsOnWhatIsBehind) {
    scene::Scene scene = litOnce();
    const double alone = meanLight(test::render(scene));
    scene.clouds.push_back(movedBy(scene.clouds[0], scene.sun.directionTo * 1000.0));
    scene.clouds[1].extinction = 1.0;  // lets nothing through but at its rim
    const double shaded = meanLight(test::render(scene));
    EXPECT_LT(shaded, 0.05 * alone);
    scene.clouds[1] = movedBy(scene.clouds[0], -scene.sun.directionTo * 1000.0);  // behind it
    EXPECT_NEAR(meanLight(test::render(scene)) / alone, 1.0, 3e-3);
    scene.clouds[1] = movedBy(scene.clouds[0], {1000.0, 0.0, 0.0});  // beside it
    EXPECT_NEAR(meanLight(test::render(scene)) / alone, 1.0, 3e-3);
}

/// A cloud that moves takes its shadow with it.
TEST(SharedShadow, FollowsACloudThatMoves) {
    scene::Scene scene = litOnce();
    scene.clouds.push_back(movedBy(scene.clouds[0], {1000.0, 0.0, 0.0}));
    Renderer renderer(scene, {.device = "", .validation = true, .keepRing = true});
    const double beside = meanLight({renderer.draw(), {}});
    renderer.setOffset(scene.sun.directionTo * 600.0 - dvec3(1000.0, 0.0, 0.0), 1);
    const double before = meanLight({renderer.draw(), {}});
    EXPECT_LT(before, 0.6 * beside);
    scene.clouds[1] = movedBy(scene.clouds[0], scene.sun.directionTo * 600.0);
    EXPECT_NEAR(before / meanLight(test::render(scene)), 1.0, 1e-3);
}

}  // namespace
}  // namespace lumulus
