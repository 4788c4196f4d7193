#include "surface/material/microfacet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::material {

using std::numbers::pi;

glm::dvec2 spreadPoint(std::uint32_t i, std::uint32_t n) {
    std::uint32_t bits = 0;
    for (std::uint32_t rest = i, place = 31; rest != 0; rest >>= 1U, --place) bits |= (rest & 1U) << place;
    return {(i + 0.5) / n, (bits + 0.5) * 0x1p-32};
}

double normals(Microfacets kind, const glm::dvec3& half, double alpha) {
    if (half.z <= 0.0) return 0.0;
    const double a2 = std::pow(std::max(alpha, smoothest), 2);
    const double sine2 = half.x * half.x + half.y * half.y, cosine2 = half.z * half.z;
    if (kind == Microfacets::beckmann) return std::exp(-sine2 / (cosine2 * a2)) / (pi * a2 * cosine2 * cosine2);
    const double denominator = sine2 + a2 * cosine2;
    return a2 / (pi * denominator * denominator);
}

double unhidden(Microfacets kind, double cosine, double alpha) {
    const double a = std::max(alpha, smoothest);
    if (kind == Microfacets::ggx) return 2.0 * cosine / (cosine + std::sqrt(a * a + (1.0 - a * a) * cosine * cosine));
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    if (cosine >= 1.6 * a * sine) return 1.0;
    const double c = cosine / (a * sine);
    return (3.535 * c + 2.181 * c * c) / (1.0 + 2.276 * c + 2.577 * c * c);
}

double visibility(Microfacets kind, double cosLight, double cosView, double alpha) {
    if (kind == Microfacets::beckmann)
        return unhidden(kind, cosLight, alpha) * unhidden(kind, cosView, alpha) / (4.0 * cosLight * cosView);
    const double a2 = std::pow(std::max(alpha, smoothest), 2);
    return 0.5 / (cosLight * std::sqrt(a2 + (1.0 - a2) * cosView * cosView) +
                  cosView * std::sqrt(a2 + (1.0 - a2) * cosLight * cosLight));
}

glm::dvec3 sampleNormal(Microfacets kind, double alpha, const glm::dvec2& u) {
    const double a = std::max(alpha, smoothest);
    const double tangent2 =
        kind == Microfacets::ggx ? a * a * u.x / (1.0 - u.x) : -a * a * std::log1p(-std::min(u.x, 1.0 - 1e-16));
    const double cosine = 1.0 / std::sqrt(1.0 + tangent2), sine = std::sqrt(tangent2) * cosine;
    return {sine * std::cos(2.0 * pi * u.y), sine * std::sin(2.0 * pi * u.y), cosine};
}

glm::dvec3 sampleSeenNormal(const glm::dvec3& view, double alpha, const glm::dvec2& u) {
    const double a = std::max(alpha, smoothest);
    const glm::dvec3 to = glm::normalize(glm::dvec3(a * view.x, a * view.y, view.z));
    const double z = (1.0 - u.y) * (1.0 + to.z) - to.z, sine = std::sqrt(std::max(0.0, 1.0 - z * z));
    const glm::dvec3 half(sine * std::cos(2.0 * pi * u.x) + to.x, sine * std::sin(2.0 * pi * u.x) + to.y, z + to.z);
    return glm::normalize(glm::dvec3(a * half.x, a * half.y, std::max(half.z, 0.0)));
}

glm::dvec3 fresnel(const glm::dvec3& reflectance, double cosHalf) {
    const double rest = 1.0 - std::clamp(cosHalf, 0.0, 1.0), rest2 = rest * rest;
    return reflectance + (glm::dvec3(1.0) - reflectance) * (rest2 * rest2 * rest);
}

}  // namespace lumulus::material
