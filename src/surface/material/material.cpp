#include "surface/material/material.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace lumulus::material {

namespace {

using std::numbers::pi;

glm::dvec3 cosineDirection(const glm::dvec2& u) {
    const double radius = std::sqrt(u.x), angle = 2.0 * pi * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1.0 - u.x)};
}

}  // namespace

glm::dvec3 Reflection::reflected(const glm::dvec3& view, const glm::dvec3& light) const {
    if (!(view.z > 0.0 && light.z > 0.0)) return glm::dvec3(0.0);
    const glm::dvec3 matte = material_.albedo / pi;
    if (!material_.facets) return matte * light.z;
    assert(table_.kind() == *material_.facets);
    const glm::dvec3 half = glm::normalize(view + light);
    const double once = normals(*material_.facets, half, material_.alpha) *
                        visibility(*material_.facets, light.z, view.z, material_.alpha);
    glm::dvec3 facets = once * fresnel(material_.reflectance, glm::dot(view, half));
    if (!material_.compensated) return (facets + matte) * light.z;
    const SplitSum split = table_.at(view.z, material_.alpha);
    const glm::dvec3 more = glm::dvec3(1.0) + material_.reflectance * (1.0 / split.energy() - 1.0);
    const glm::dvec3 sent = (material_.reflectance * split.scale + split.bias) * more;
    return (facets * more + matte * (glm::dvec3(1.0) - sent)) * light.z;
}

/// Share of the samples that are drawn by the microfacets.
double Reflection::facetShare() const {
    if (!material_.facets) return 0.0;
    return material_.albedo == glm::dvec3(0.0) ? 1.0 : 0.5;
}

double Reflection::facetDensity(const glm::dvec3& view, const glm::dvec3& light) const {
    const Microfacets kind = *material_.facets;
    const glm::dvec3 half = glm::normalize(view + light);
    const double facets = normals(kind, half, material_.alpha);
    if (kind == Microfacets::ggx) return facets * unhidden(kind, view.z, material_.alpha) / (4.0 * view.z);
    return facets * half.z / (4.0 * glm::dot(view, half));
}

LightSample Reflection::sample(const glm::dvec3& view, const glm::dvec2& u) const {
    const double share = facetShare();
    LightSample result;
    if (u.x < share) {
        const glm::dvec2 rest(u.x / share, u.y);
        const Microfacets kind = *material_.facets;
        const glm::dvec3 half = kind == Microfacets::ggx ? sampleSeenNormal(view, material_.alpha, rest)
                                                         : sampleNormal(kind, material_.alpha, rest);
        result.light = 2.0 * glm::dot(view, half) * half - view;
        if (!(glm::dot(view, half) > 0.0)) return result;
    } else {
        result.light = cosineDirection({(u.x - share) / (1.0 - share), u.y});
    }
    result.density = density(view, result.light);
    return result;
}

double Reflection::density(const glm::dvec3& view, const glm::dvec3& light) const {
    if (!(view.z > 0.0 && light.z > 0.0)) return 0.0;
    const double share = facetShare();
    return (share > 0.0 ? share * facetDensity(view, light) : 0.0) + (1.0 - share) * light.z / pi;
}

}  // namespace lumulus::material
