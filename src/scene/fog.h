#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <vector>

/// The fog of a scene: analytic media and the screen-space filter that shows them (docs/fog.md).
namespace lumulus::scene {

enum class MediumKind { homogeneous, exponential, sphere, ellipsoid, box };

/// An analytic medium. Its coefficients hold where the relative density ϱ is 1.
struct FogMedium {
    MediumKind kind = MediumKind::homogeneous;
    glm::dvec3 scattering{0.0};           ///< 1/m, RGB
    glm::dvec3 absorption{0.0};           ///< 1/m, RGB
    double g = 0.9;                       ///< mean cosine of scattering
    glm::dvec3 emission{0.0};             ///< W/(m³ sr): radiance gained per metre
    double falloff = 0.01;                ///< exponential: ϱ = exp(−falloff ⟨x − offset, direction⟩), 1/m
    glm::dvec3 direction{0.0, 1.0, 0.0};  ///< exponential: unit vector towards thinner fog
    glm::dvec3 offset{0.0};               ///< exponential: a point where ϱ = 1
    glm::dvec3 center{0.0};               ///< sphere: ϱ = 1 − |x − center|²/radius² inside, 0 outside
    double radius = 100.0;                ///< sphere, metres
    glm::dvec3 halfSize{100.0};           ///< ellipsoid, box around `center`: ϱ = 1 inside. Semi-axes or half edges
    /// homogeneous, exponential: heights between which the medium lies, metres. Infinite where there is no such end
    double bottom = -std::numeric_limits<double>::infinity();
    double top = std::numeric_limits<double>::infinity();

    bool operator==(const FogMedium&) const = default;
};

enum class FogFilter { scatter, masked, naive, gather };
enum class FogFetch { bilinear, linearBicubic, cubicBicubic };
enum class FogDepth { distance, planar, zbuffer };

struct Fog {
    FogFilter filter = FogFilter::scatter;
    int filterSize = 4;  ///< width in taps of the filter between levels: 2, 4 or 6
    FogFetch fetch = FogFetch::linearBicubic;
    int depthLookups = 2;                 ///< masked: number of look-ups of the level in the depth chain
    double separationLuminance = 3.0;     ///< masked: luminance above which light is separated, W/(m² sr)
    double separationSpread = 0.05;       ///< masked: largest spread of separated light, share of the height
    double separation = 1.0;              ///< masked: strength of the separation of bright near pixels
    double separationLevel = 0.7;         ///< masked: share of the level at which separated pixels are read
    double skyDistance = 1e5;             ///< metres from the eye at which media without an end stop
    bool inscattering = true;             ///< reference: fog also scatters light that comes straight from sun and sky
    FogDepth depth = FogDepth::distance;  ///< meaning of the depth file of `lumulus composite`
    double near = 0.1, far = 1000.0;      ///< metres: range of a z-buffer
    std::vector<FogMedium> media;         ///< empty: no fog

    bool operator==(const Fog&) const = default;
};

}  // namespace lumulus::scene
