#pragma once

#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "fog/screen/fog.h"
#include "render/gpu_work.h"
#include "render/world.h"
#include "surface/ground_light.h"
#include "surface/ground_picture.h"

namespace lumulus {

/// The ground of a world as pictures show it: its light is made anew where sun or clouds have changed.
class GroundView {
  public:
    /// Brings the light on the ground up to date. Errors: what `check` throws.
    const surface::GroundLight& light(gpu::Context& context, World& world, const Check& check);

  private:
    /// What the light on the ground depends on.
    struct Cause {
        glm::dvec3 directionTo{0.0}, irradiance{0.0};
        std::vector<glm::dvec3> places;
        std::vector<double> extinctions;

        bool operator==(const Cause&) const = default;
    };

    std::optional<surface::GroundLight> light_;
    Cause cause_;
};

/// Throws InputError where a camera is below the ground.
void requireAbove(const scene::Ground& ground, const Camera& camera);

/// What is behind the clouds as seen through fog: ground, sky and the sun's disc, RGB row by row.
std::vector<glm::vec4> groundThroughFog(fog::Fog& fog, const Camera& camera,
                                        const std::vector<surface::GroundPixel>& ground, const glm::dvec3& sky,
                                        const std::vector<shared::SunPixel>& sun);

/// Puts what is behind the clouds into a part of a picture of that width: R, G, B = cloud + transmittance · behind.
void layBehind(LayeredImage& image, const std::vector<glm::vec4>& behind, const Tile& part, int width);

}  // namespace lumulus
