#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/random.h"
#include "scene/sky.h"

namespace lumulus::reference {

/// A direction to the map, drawn by its brightness.
struct SkyMapSample {
    glm::dvec3 direction{0.0};
    double density = 0.0;  ///< 1/sr
};

/// The sky as a picture of the whole sphere: twice as wide as high, the zenith at the upper edge, −Z in the middle of
/// its width and +X a quarter of the width to the right of that. Radiance is bilinear between the middles of pixels, in
/// longitude all around.
///
/// Where `map_sun` is true, a compact bright spot is taken out and becomes the sun. The spot is made of the pixels
/// within 5° of the brightest one that have a tenth of its luminance at least; it counts as a sun where the brightest
/// pixel has 50 times the mean luminance of the ring from 5° to 10° around it. Its pixels get the mean radiance of the
/// ring, and the rest of their light is the sun's: a disc of the spot's solid angle in its middle.
class SkyMap {
  public:
    /// Reads `sky.map`. Errors: InputError that names `sky.map` for a file that cannot be read, has no channels R, G
    /// and B, is not twice as wide as high, or holds values below 0, NaN or infinity; or no light at all.
    explicit SkyMap(const scene::Sky& sky);

    /// W·m⁻²·sr⁻¹.
    glm::dvec3 radiance(const glm::dvec3& direction) const;

    SkyMapSample sample(Random& random) const;

    /// Density with which `sample` draws a direction, 1/sr. It is not 0 where there is radiance.
    double density(const glm::dvec3& direction) const;

    /// The sun of the map, with direction, irradiance and diameter; absent where it has none or keeps it.
    const std::optional<scene::Sun>& sun() const { return sun_; }

  private:
    /// A point of the picture in pixels.
    glm::dvec2 placeOf(const glm::dvec3& direction) const;
    glm::dvec3 directionOf(const glm::dvec2& place) const;
    double solidAngle(int y) const;
    std::size_t indexOf(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    void takeOutSun();
    void weigh();

    int width_ = 0, height_ = 0;
    double rotation_;                 ///< radians
    std::vector<glm::vec3> pixels_;   ///< rows from the top
    std::vector<double> cumulative_;  ///< weight of each pixel and those before it
    std::optional<scene::Sun> sun_;
};

}  // namespace lumulus::reference
