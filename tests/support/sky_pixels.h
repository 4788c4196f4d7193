#pragma once

#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include "sky/environment.h"
#include "support/small_scene.h"
#include "view/camera.h"

namespace lumulus::test {

/// Pixels beside the cloud have the radiance that the environment answers, to 1 %: of the sky, and of the ground.
inline void expectPixelsOfTheSky(scene::Scene scene, const sky::Environment& environment) {
    scene.camera.position = glm::dvec3(0.0, 60.0, 800.0);
    scene.camera.target = glm::dvec3(0.0, 100.0, 0.0);
    scene.camera.verticalFov = 90.0;
    const Frame frame = render(scene);
    const Camera camera = makeCamera(scene.camera, scene.image, Bounds{});
    for (const glm::ivec2 pixel : {glm::ivec2(2, 2), {16, 1}, {29, 7}, {1, 22}, {16, 21}}) {
        const glm::dvec3 direction = camera.ray(pixel.x + 0.5, pixel.y + 0.5).direction;
        const glm::dvec3 exact = environment.radiance(camera.position, direction, scene.sun);
        int c = 0;
        for (const char* name : {"R", "G", "B"}) {
            const float seen =
                frame.image.layers.at(name)[static_cast<std::size_t>(pixel.y * scene.image.width + pixel.x)];
            EXPECT_NEAR(static_cast<double>(seen), exact[c], 0.01 * exact[c]) << name << " of pixel " << pixel.x;
            ++c;
        }
    }
}

}  // namespace lumulus::test
