#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "view/camera.h"
#include "view/view.h"

namespace lumulus::frame {

/// A pixel that the sun's disc covers in part.
struct CoveredPixel {
    glm::ivec2 pixel{0};
    double share = 0.0;  ///< of the pixel's solid angle
};

/// The pixels of the part `tile` that see the disc of that angular radius (below 90°) about a direction, row by row.
/// Over a whole panorama, shares times the pixels' solid angles add up to that of the disc, however small it is and
/// wherever it lies. An orthographic view sees one direction: all of its pixels see the disc or none does.
std::vector<CoveredPixel> sunCover(const Camera& camera, const Tile& tile, const glm::dvec3& directionTo,
                                   double radius);

}  // namespace lumulus::frame
