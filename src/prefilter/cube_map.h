#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
#include "prefilter/panorama.h"

namespace lumulus::prefilter {

/// Radiance on the faces of a cube, with mip levels down to one texel a face, for reading at any level of detail. It
/// never changes.
class CubeMap {
  public:
    /// `size`: texels along an edge of a face, a power of two. Each texel is the mean of 4 × 4 readings of the
    /// panorama, texels of further levels the mean of four by their solid angle. Errors: what `check` throws, on any
    /// thread.
    CubeMap(const Panorama& panorama, int size, const Check& check);

    int size() const { return size_; }
    int levels() const { return static_cast<int>(levels_.size()); }
    /// Linear between texels, also across edges, and between levels. `level`: 0 to levels() − 1, held within.
    glm::vec3 at(const glm::vec3& direction, float level) const;

  private:
    /// Faces with a rim of one texel all around, which holds what is beyond the edge.
    struct Level {
        int size = 0;
        std::vector<glm::vec4> texels;

        std::size_t place(int face, int x, int y) const {
            const auto across = static_cast<std::size_t>(size) + 2;
            return (static_cast<std::size_t>(face) * across + static_cast<std::size_t>(y + 1)) * across +
                   static_cast<std::size_t>(x + 1);
        }
        glm::vec4 at(int face, const glm::vec2& place) const;
    };
    static void fillRim(Level& level);
    static Level smaller(const Level& level);

    int size_;
    std::vector<Level> levels_;
};

}  // namespace lumulus::prefilter
