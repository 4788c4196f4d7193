#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
#include "query/media.h"
#include "scene/scene.h"

namespace lumulus::surface {

/// Values at the nodes of a level grid, bilinear between them and one value outside of it.
struct GroundGrid {
    glm::dvec2 lower{0.0}, upper{0.0};  ///< x and z of the first and the last node [m]
    glm::ivec2 nodes{0};                ///< along x and z; none: `outside` holds everywhere
    std::vector<glm::vec3> values;      ///< x fastest
    glm::vec3 outside{1.0F};

    glm::dvec2 node(int x, int z) const;
    glm::dvec3 at(const glm::dvec2& place) const;
};

/// Light that falls on the ground of a scene, straight from the sun and straight from the sky, through all that is
/// above it. Valid for one sun and for clouds that stay where they are.
class GroundLight {
  public:
    /// `sky` is the radiance of a sky that is the same everywhere [W/(m² sr)]. Errors: what `check` throws.
    GroundLight(const scene::Ground& ground, const query::Media& media, const scene::Sun& sun, const glm::dvec3& sky,
                const Check& check);

    double height() const { return ground_.height; }
    /// Radiance of the ground at a place, the same in all directions [W/(m² sr)].
    glm::dvec3 radiance(const glm::dvec2& place) const;

  private:
    scene::Ground ground_;
    glm::dvec3 openSun_, openSky_;  ///< irradiance without anything above [W/m²]
    GroundGrid sun_, sky_;          ///< shares of it that arrive
};

}  // namespace lumulus::surface
