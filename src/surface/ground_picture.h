#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "base/image.h"
#include "shared/frame.h"
#include "surface/ground_light.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::surface {

/// Metres along a ray to the level plane at `height`; absent where it is not met from above. In doubles and by the
/// height of the eye above the plane, so that a far origin costs no digits.
std::optional<double> distanceToGround(const Ray& ray, double height);

/// What a pixel shows of the ground.
struct GroundPixel {
    glm::vec3 radiance{0.0F};  ///< mean over the part of the pixel that shows it [W/(m² sr)]
    float share = 0.0F;        ///< of the pixel
    float distance = 0.0F;     ///< mean along the ray, metres
};

/// The ground as the pixels of a part of a picture see it, row by row, without what is in the way.
std::vector<GroundPixel> seenGround(const Camera& camera, const Tile& tile, const GroundLight& light);

/// Takes away the pixels of the sun's disc that lie below the horizon.
void hideSun(std::vector<shared::SunPixel>& sun, const std::vector<GroundPixel>& ground, int width);

/// Lays the ground behind the clouds of a picture: R, G, B show it instead of a sky of that radiance, depth.Z and
/// depth.front are those of clouds and ground together.
void addGround(LayeredImage& image, const std::vector<GroundPixel>& ground, const glm::dvec3& sky);

/// The depths alone.
void addGroundDepth(LayeredImage& image, const std::vector<GroundPixel>& ground);

}  // namespace lumulus::surface
