#pragma once

#include <cstdint>
#include <glm/glm.hpp>

/// Distributions of microfacets, and what they hide of each other. Directions are unit vectors in the frame of the
/// surface: z is the normal, `view` points to the eye, `light` to the light. `alpha` is the width of a distribution,
/// `smoothest` at least.
namespace lumulus::material {

/// Below it, a lobe is narrower than what numbers and samplers resolve; smoother surfaces count as this one.
inline constexpr double smoothest = 1e-3;

enum class Microfacets { ggx, beckmann };

/// Point i of n well-spread points of the unit square (Hammersley): deterministic, for quadrature.
glm::dvec2 spreadPoint(std::uint32_t i, std::uint32_t n);

/// Density of microfacet normals [1/sr of facet normals per area of surface]: its integral times z is 1.
/// GGX: Walter et al. 2007, eq. 33. Beckmann: eq. 25.
double normals(Microfacets kind, const glm::dvec3& half, double alpha);

/// Share of the microfacets towards a direction that others do not hide (Smith): exact for GGX, the rational
/// approximation of Walter et al. 2007, eq. 27, for Beckmann (0.35 %). `cosine`: of the direction and the normal, > 0.
double unhidden(Microfacets kind, double cosine, double alpha);

/// Shadowing and masking over 4 (n·l)(n·v): height-correlated for GGX (Heitz 2014), the product of both sides for
/// Beckmann, as Cook and Torrance have it.
double visibility(Microfacets kind, double cosLight, double cosView, double alpha);

/// A microfacet normal, drawn with the density normals() · z by two numbers in [0,1).
glm::dvec3 sampleNormal(Microfacets kind, double alpha, const glm::dvec2& u);

/// A normal of the GGX microfacets that are seen from `view` (z > 0): density unhidden · (view·h) · normals / view.z
/// (Heitz 2018). Drawn from the cap of a sphere by two numbers in [0,1) (Dupuy and Benyoub 2023).
glm::dvec3 sampleSeenNormal(const glm::dvec3& view, double alpha, const glm::dvec2& u);

/// Share of light that a mirror of this reflectance at normal incidence sends back (Schlick 1994).
glm::dvec3 fresnel(const glm::dvec3& reflectance, double cosHalf);

}  // namespace lumulus::material
