#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "render/renderer.h"

namespace lumulus {

/// Light from all around a point as real spherical harmonics of three bands: L(ω) ≈ Σ c_i y_i(ω).
struct AmbientLight {
    std::array<glm::dvec3, 9> coefficients{};  ///< c_i, per channel [W m⁻² sr^−½]

    /// Irradiance of a plane with this normal [W/m²]: Σ A_l c_i y_i(n), A = π, 2π/3, π/4 (Ramamoorthi and Hanrahan
    /// 2001).
    glm::dvec3 irradiance(const glm::dvec3& normal) const;
};

/// The nine basis functions at a unit vector of the world, in the order of Ramamoorthi and Hanrahan (2001):
/// 1; y, z, x; xy, yz, 3z² − 1, xz, x² − y².
std::array<double, 9> ambientBasis(const glm::dvec3& direction);

/// The same as formulas, for people and files.
inline constexpr std::array ambientFormulas{"0.28209479177387814",
                                            "0.4886025119029199 y",
                                            "0.4886025119029199 z",
                                            "0.4886025119029199 x",
                                            "1.0925484305920792 x y",
                                            "1.0925484305920792 y z",
                                            "0.31539156525252005 (3 z^2 - 1)",
                                            "1.0925484305920792 x z",
                                            "0.5462742152960396 (x^2 - y^2)"};

/// Projects radiance that is given for the middles of the pixels of a panorama (rows from the zenith, the middle column
/// north) on the basis.
AmbientLight projectPanorama(std::span<const float> red, std::span<const float> green, std::span<const float> blue,
                             int width, int height);

/// Irradiance by the sun, or the moon, on a plane that faces it at a point [W/m²]: what clouds, fog and air let
/// through. `media`: those of the renderer. Errors: what `check` throws.
glm::dvec3 sunIrradianceAt(const Renderer& renderer, const query::Media& media, const glm::dvec3& point,
                           const Check& check);

/// Light from clouds, sky and ground at a point, without what comes straight from the sun. `renderer` has traced its
/// photons. Errors: those of Renderer::draw.
AmbientLight ambientAt(Renderer& renderer, ViewState& state, const glm::dvec3& point);

}  // namespace lumulus
