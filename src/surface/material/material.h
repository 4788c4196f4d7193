#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "surface/material/energy.h"

namespace lumulus::material {

/// How a surface reflects light: microfacets above a matte base. Frame and directions as in microfacet.h.
struct Material {
    std::optional<Microfacets> facets;  ///< GGX, or Beckmann as Cook and Torrance have it; none: matte alone (Lambert)
    double alpha = 0.25;                ///< of the microfacets, 0 to 1: roughness² of glTF
    glm::dvec3 reflectance{0.04};       ///< of the microfacets at normal incidence, by channel
    glm::dvec3 albedo{0.0};             ///< of the base, by channel; 0 for a metal
    /// Whether light that facets send to one another comes back (Turquin 2019), and the base gets what they leave over.
    /// The reflection then depends on the view in a way in which it does not on the light.
    bool compensated = true;
};

/// A direction to a light, and the density with which it was drawn [1/sr]; 0: none was drawn.
struct LightSample {
    glm::dvec3 light{0.0, 0.0, 1.0};
    double density = 0.0;
};

/// A material with the table of its microfacets.
class Reflection {
  public:
    /// `table`: of the material's microfacets; it outlives this object.
    Reflection(const Material& material, const EnergyTable& table) : material_(material), table_(table) {}

    /// Radiance towards `view` by irradiance 1 of a plane that faces a light in direction `light`: the BRDF times
    /// light.z [1/sr], by channel. 0 where one of them is below the surface.
    glm::dvec3 reflected(const glm::dvec3& view, const glm::dvec3& light) const;
    /// Draws a direction to a light by two numbers in [0,1): seen normals of GGX, normals of Beckmann, cosines of the
    /// base, the two of a material with both equally often. `view.z` > 0.
    LightSample sample(const glm::dvec3& view, const glm::dvec2& u) const;
    /// Density with which sample() draws a direction [1/sr].
    double density(const glm::dvec3& view, const glm::dvec3& light) const;

  private:
    double facetShare() const;
    double facetDensity(const glm::dvec3& view, const glm::dvec3& light) const;

    Material material_;
    const EnergyTable& table_;
};

}  // namespace lumulus::material
