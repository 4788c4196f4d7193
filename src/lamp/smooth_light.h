#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "lamp/haze.h"
#include "lamp/lamp_tree.h"
#include "lamp/ray_bundle.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// Part of the whole picture, in pixels.
struct Square {
    glm::ivec2 first{0};
    int edge = 8;
};

/// The rays of a square's pixels and of its corners, which end after so many metres.
RayBundle bundleOf(const Camera& camera, const Square& square, double end);

/// A picture that light is added to.
struct LitPicture {
    const Camera& camera;
    double farAway = 0.0;                                                ///< end of rays that meet nothing [m]
    std::function<double(const Ray&)> end{};                             ///< of a ray [m]
    std::function<double(const glm::ivec2& pixel, const Ray&)> endIn{};  ///< the same, which may be a lamp's disc
    std::function<glm::dvec3*(const glm::ivec2& pixel)> light{};         ///< null: the pixel is not wanted
};

/// Adds light of lamps that fog scatters once, which is smooth but near the lamps: it is interpolated in the largest
/// parts of the picture where that serves. Near a lamp the product of the light and of the distance at which a ray
/// passes the lamp is interpolated. `solid`: the square shows solid bodies, so that nothing is interpolated.
void addSmoothLight(const LitPicture& picture, const Haze& haze, std::span<const LampNode* const> groups,
                    const Square& square, bool solid);

/// Light of a lamp that fog scatters once in a square of a pixel, or of a part of one.
glm::dvec3 scatteredIn(const LitPicture& picture, const Haze& haze, const Beam& beam, const glm::dvec2& place,
                       const glm::ivec2& pixel, double edge);

/// Share of all light below which that of a lamp is interpolated anyhow.
constexpr double faintShare = 1e-3;

}  // namespace lumulus::lamp
