#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "lamp/beam.h"
#include "lamp/light_path.h"
#include "lamp/picture_plane.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// Light of lamps that fog, clouds and ground have scattered twice or more, as a picture has it. It is traced from the
/// lamps: each scattering event sends its share to the eye, into the cell of the picture where it is seen. Cells are
/// averaged over as many neighbours as the spread of their shares asks for; those of clouds by how much of each cell
/// clouds cover, so that light does not leave them at their sides.
class Glow {
  public:
    struct Paths {
        std::uint64_t count = 0, seed = 1;
    };

    /// The same for any number of threads. Errors: what `check` throws.
    Glow(const Camera& camera, const Around& around, std::span<const Beam> beams, const Paths& paths,
         const Check& check);

    /// Radiance at a place of the whole picture, in pixels [W/(m² sr)]. `cover`: what clouds hide there, 0 to 1.
    glm::dvec3 at(const glm::dvec2& place, double cover) const;

  private:
    /// Sums over cells, rows from the top; each level has half as many along each axis.
    struct Level {
        glm::ivec2 size{0};
        std::vector<glm::vec3> light;    ///< over the picture's solid angle
        std::vector<float> sum, square;  ///< of the shares' luminance
        std::vector<float> solidAngle;   ///< of what sends the light: all of the cell, or the part that clouds cover

        explicit Level(const glm::ivec2& cells);
        void add(std::size_t i, const glm::dvec3& share);
        void add(const Level& other);
        float effective(std::size_t i) const { return square[i] > 0.0F ? sum[i] * sum[i] / square[i] : 0.0F; }
    };
    using Levels = std::vector<Level>;  ///< the finest first
    struct Kinds;

    void findSolidAngles(const Camera& camera, const PicturePlane& plane, const Clouds& clouds, const Check& check,
                         Kinds& kinds) const;
    static void addLevels(Levels& levels);
    glm::dvec3 mean(const Levels& levels, const glm::dvec2& place, bool ofClouds) const;

    int cell_ = 1;    ///< edge of the finest cells, pixels
    int margin_ = 0;  ///< of cells around the picture, pixels
    Levels levels_, cloudLevels_;
};

}  // namespace lumulus::lamp
