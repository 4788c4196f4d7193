#pragma once

#include <array>
#include <functional>
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
    /// Averages with binomial weights over 3 × 3 nodes.
    void smooth();
};

/// What meshes leave of the light on the ground, and what they add.
struct GroundMeshes {
    std::function<double(const glm::dvec2&)> sun{};     ///< share of the sun's light that reaches a place; none: all
    GroundGrid sky{};                                   ///< share of the light of all directions
    GroundGrid added{{}, {}, {}, {}, glm::vec3(0.0F)};  ///< irradiance by light that they send down [W/m²]
    glm::dvec2 lower{0.0}, upper{0.0};                  ///< x and z between which shadows of the sun may lie [m]

    double sunAt(const glm::dvec2& place) const { return sun ? sun(place) : 1.0; }
};

/// Light that falls on the ground of a scene, straight from the sun and straight from the sky, through all that is
/// above it. Valid for clouds that stay where they are against each other, and at their height.
class GroundLight {
  public:
    /// Under a sky of a radiance that is the same everywhere [W/(m² sr)], without a sun. Errors: what `check` throws.
    GroundLight(const scene::Ground& ground, const query::Media& media, const glm::dvec3& sky, const Check& check);

    /// Sets the sun, of which the shadow is known at about so many nodes. Errors: as above.
    void setSun(const query::Media& media, const scene::Sun& sun, double nodes, const Check& check);
    /// Sets the radiance of the sky, which is the same everywhere [W/(m² sr)].
    void setSky(const glm::dvec3& radiance);
    /// Sets what meshes do, of this sun and sky.
    void setMeshes(GroundMeshes meshes);
    /// Moves the shadows by so far along x and z from where they were made [m].
    void setDrift(const glm::dvec2& drift) { drift_ = drift; }

    const scene::Ground& ground() const { return ground_; }
    double height() const { return ground_.height; }
    /// Radiance of the ground at a place, the same in all directions [W/(m² sr)].
    glm::dvec3 radiance(const glm::dvec2& place) const;
    /// The same without the light that clouds send down, and where nothing is above.
    glm::dvec3 directRadiance(const glm::dvec2& place) const;
    glm::dvec3 openRadiance() const;
    /// Where radiance() may differ from openRadiance(): corners, x and z [m].
    std::array<glm::dvec2, 2> shaded() const;
    /// Sets the irradiance by light that clouds send down [W/m²].
    void setClouds(GroundGrid irradiance);

  private:
    glm::dvec3 onGround(const glm::dvec2& place) const;

    scene::Ground ground_;
    glm::dvec3 openSun_{0.0}, openSky_;  ///< irradiance without anything above [W/m²]
    glm::dvec2 drift_{0.0};
    GroundGrid sun_, sky_;  ///< shares of it that arrive
    GroundGrid clouds_;     ///< irradiance [W/m²]
    GroundMeshes meshes_;
};

}  // namespace lumulus::surface
