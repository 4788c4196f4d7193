#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "reference/random.h"
#include "view/camera.h"

namespace lumulus::reference {

/// Which part of each pixel the sun's disc covers, by solid angle: the disc may be much smaller than a pixel, so that
/// random points of pixels rarely meet it. Found by dividing pixels until their parts lie in the disc or beside it.
class DiscCover {
  public:
    /// The covered part of one pixel.
    struct Pixel {
        bool crossed = false;  ///< whether a part of the pixel lies beyond the disc
        double share = 0.0;    ///< of the pixel's solid angle
        /// A point of the covered part in pixel coordinates, all of its directions equally likely.
        glm::dvec2 sample(Random& random) const;

        struct Square {
            glm::dvec2 corner{0.0};
            double edge = 0.0;    ///< pixels
            double before = 0.0;  ///< solid angle of this square and those before
        };
        std::vector<Square> squares;
    };

    /// `radius` of the disc in radians; 0: a point, which covers nothing.
    DiscCover(const Camera& camera, const glm::dvec3& sunDirection, double radius);

    /// The pixel, or null where the disc does not cover any of it.
    const Pixel* find(int x, int y) const;

  private:
    void divide(const glm::dvec2& corner, double edge, Pixel& pixel) const;
    double solidAngle(const glm::dvec2& corner, double edge, int parts) const;

    Camera camera_;
    glm::dvec3 sunDirection_;
    double radius_;
    std::unordered_map<std::size_t, Pixel> pixels_;
};

}  // namespace lumulus::reference
