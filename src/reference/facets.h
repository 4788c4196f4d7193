#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "reference/random.h"

namespace lumulus::reference {

/// What a surface of glTF is made of at a point.
struct Facets {
    glm::dvec3 colour{1.0};  ///< base colour
    double metallic = 0.0;
    double alpha = 1.0;  ///< width of the GGX distribution, roughness²
};

/// Energy that facets of GGX send back once, of light that comes from everywhere: reflectance · scale + bias.
class FacetEnergy {
  public:
    FacetEnergy();

    glm::dvec2 at(double cosView, double alpha) const;  ///< scale and bias

  private:
    std::vector<glm::dvec2> nodes_;  ///< cosView fastest
};

/// Reflection by facets of GGX (Walter et al. 2007) with height-correlated shadowing, Schlick's Fresnel, what facets
/// send to one another (Turquin 2019), and a Lambert base below that gets what the facets leave over. The normal is +z
/// of a frame of its own; directions are unit vectors away from the surface.
class FacetReflection {
  public:
    FacetReflection(const Facets& facets, const FacetEnergy& energy);

    /// BRDF times the cosine of the light [1/sr], by channel; 0 below the surface.
    glm::dvec3 value(const glm::dvec3& view, const glm::dvec3& light) const;
    /// Draws a light for a view; `density` says how likely. It may lie below the surface, where both are 0.
    glm::dvec3 sample(const glm::dvec3& view, Random& random) const;
    double density(const glm::dvec3& view, const glm::dvec3& light) const;

  private:
    glm::dvec3 reflectance_, base_;
    double alpha_;
    double facetShare_;  ///< of the samples
    const FacetEnergy& energy_;
};

}  // namespace lumulus::reference
