#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lumulus::sky {

/// Radiance by direction: latitude by longitude, twice as wide as high, rows from the zenith down, −Z in the middle of
/// the width and +X a quarter of it to the right, before the map's rotation. W/(m² sr).
struct LatLong {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;

    const glm::vec3& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    /// Of a pixel in the row y [sr].
    double solidAngle(int y) const;
};

/// A picture of the surroundings as the sky. Between the middles of pixels its radiance is bilinear, in longitude all
/// around. It never changes.
///
/// Where `sky.map_sun` is true, a compact bright spot becomes the sun: the pixels within 5° of the brightest one that
/// have a tenth of its luminance at least, where it has 50 times the mean luminance of the ring from 5° to 10° around.
/// They get the mean of the ring; the rest of their light is that of a disc of their solid angle, in their middle.
class MapSky {
  public:
    /// Reads `sky.map`. Errors: InputError that names `sky.map` where the file cannot be read, has no channels R, G and
    /// B, is not twice as wide as high, holds values below 0, NaN or infinity, or no light.
    explicit MapSky(const scene::Sky& sky);

    glm::dvec3 radiance(const glm::dvec3& direction) const;
    /// Mean over all directions.
    const glm::dvec3& mean() const { return mean_; }
    /// On a plane with this normal [W/m²], without the sun that was taken out.
    glm::dvec3 irradiance(const glm::dvec3& normal) const;
    /// The sun that was taken out of the map.
    const std::optional<scene::Sun>& sun() const { return sun_; }
    const LatLong& pixels() const { return pixels_; }
    /// From the frame of the pixels to the world: horizontally towards the map's left edge, up, and a quarter of the
    /// width to the right of that edge.
    glm::dmat3 axes() const;
    /// The same light in pixels that are nearly the same all over: about `width` of them across, by interpolation where
    /// the map has fewer.
    LatLong cells(int width) const;

  private:
    glm::dvec3 directionOf(const glm::dvec2& place) const;
    void takeOutSun();

    LatLong pixels_;
    double rotation_ = 0.0;  ///< clockwise seen from above [radians]
    glm::dvec3 mean_{0.0};
    std::optional<scene::Sun> sun_;
};

/// The same light in `width` pixels across, an even number below that of the map. Each has the mean over its solid
/// angle: what comes from a part of the sky does not change.
LatLong reduced(const LatLong& map, int width);

}  // namespace lumulus::sky
