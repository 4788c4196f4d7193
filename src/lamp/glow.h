#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "lamp/beam.h"
#include "lamp/haze.h"
#include "scene/sky.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// Light of lamps that fog and ground have scattered twice or more, as a picture has it. It is traced from the lamps:
/// each scattering event sends its share to the eye, into the cell of the picture where it is seen. Cells are averaged
/// over as many neighbours as the spread of their shares asks for.
class Glow {
  public:
    struct Paths {
        std::uint64_t count = 0, seed = 1;
    };

    /// The same for any number of threads. Errors: what `check` throws.
    Glow(const Camera& camera, const Haze& haze, std::span<const Beam> beams,
         const std::optional<scene::Ground>& ground, const Paths& paths, const Check& check);

    /// Radiance at a place of the whole picture, in pixels [W/(m² sr)].
    glm::dvec3 at(const glm::dvec2& place) const;

  private:
    /// Sums over cells, rows from the top; each level has half as many along each axis.
    struct Level {
        glm::ivec2 size{0};
        std::vector<glm::vec3> light;    ///< over the picture's solid angle
        std::vector<float> sum, square;  ///< of the shares' luminance
        std::vector<float> solidAngle;

        float effective(std::size_t i) const { return square[i] > 0.0F ? sum[i] * sum[i] / square[i] : 0.0F; }
    };

    void addLevels();

    int cell_ = 1;    ///< edge of the finest cells, pixels
    int margin_ = 0;  ///< of cells around the picture, pixels
    std::vector<Level> levels_;
};

}  // namespace lumulus::lamp
