#include "reference/facets.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lumulus::reference {
namespace {

constexpr double pi = glm::pi<double>();
constexpr int nodes = 40;            // of the table, along each axis
constexpr int strata = 40;           // of the integral, along each axis
constexpr double leastAlpha = 1e-3;  // smoother surfaces count as this one

double square(double x) {
    return x * x;
}

/// Smith's auxiliary function of GGX: masking is 1 / (1 + it).
double lambda(double cosine, double alpha) {
    const double tangent2 = (1.0 - square(cosine)) / square(cosine);
    return 0.5 * (std::sqrt(1.0 + square(alpha) * tangent2) - 1.0);
}

double distribution(double cosHalf, double alpha) {
    const double rest = 1.0 + square(cosHalf) * (square(alpha) - 1.0);
    return square(alpha) / (pi * square(rest));
}

double schlick(double cosine) {
    return std::pow(std::max(0.0, 1.0 - cosine), 5.0);
}

/// A normal of the facets that a view sees, by a disc across the view (Heitz 2018).
glm::dvec3 seenNormal(const glm::dvec3& view, double alpha, double u, double v) {
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * view.x, alpha * view.y, view.z));
    const double flat = square(stretched.x) + square(stretched.y);
    const glm::dvec3 first =
        flat > 0.0 ? glm::dvec3(-stretched.y, stretched.x, 0.0) / std::sqrt(flat) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 second = glm::cross(stretched, first);
    const double radius = std::sqrt(u), angle = 2.0 * pi * v, share = 0.5 * (1.0 + stretched.z);
    const double x = radius * std::cos(angle);
    const double y = (1.0 - share) * std::sqrt(1.0 - square(x)) + share * radius * std::sin(angle);
    const glm::dvec3 normal =
        x * first + y * second + std::sqrt(std::max(0.0, 1.0 - square(x) - square(y))) * stretched;
    return glm::normalize(glm::dvec3(alpha * normal.x, alpha * normal.y, std::max(1e-12, normal.z)));
}

}  // namespace

FacetEnergy::FacetEnergy() {
    for (int a = 0; a < nodes; ++a)
        for (int c = 0; c < nodes; ++c) {
            const double cosine = std::max(1e-3, square(c / (nodes - 1.0)));
            const double alpha = std::max(leastAlpha, square(a / (nodes - 1.0)));
            const glm::dvec3 view(std::sqrt(1.0 - square(cosine)), 0.0, cosine);
            glm::dvec2 sum(0.0);
            for (int i = 0; i < strata * strata; ++i) {
                const glm::dvec3 half =
                    seenNormal(view, alpha, (i % strata + 0.5) / strata, (i / strata + 0.5) / strata);
                const double cosLight = 2.0 * glm::dot(view, half) * half.z - view.z;
                if (!(cosLight > 0.0)) continue;
                const double away = lambda(cosine, alpha);
                const double passed = (1.0 + away) / (1.0 + away + lambda(cosLight, alpha));
                const double fresnel = schlick(glm::dot(view, half));
                sum += passed * glm::dvec2(1.0 - fresnel, fresnel);
            }
            nodes_.push_back(sum / square(strata));
        }
}

glm::dvec2 FacetEnergy::at(double cosView, double alpha) const {
    const auto place = [](double value) { return std::sqrt(std::clamp(value, 0.0, 1.0)) * (nodes - 1); };
    const double x = place(cosView), y = place(alpha);
    const int left = std::min(static_cast<int>(x), nodes - 2), top = std::min(static_cast<int>(y), nodes - 2);
    const auto node = [&](int i, int j) { return nodes_[static_cast<std::size_t>((top + j) * nodes + left + i)]; };
    const double fx = x - left, fy = y - top;
    return (1.0 - fy) * ((1.0 - fx) * node(0, 0) + fx * node(1, 0)) + fy * ((1.0 - fx) * node(0, 1) + fx * node(1, 1));
}

FacetReflection::FacetReflection(const Facets& facets, const FacetEnergy& energy)
    : reflectance_(glm::mix(glm::dvec3(0.04), facets.colour, facets.metallic)),
      base_((1.0 - facets.metallic) * facets.colour),
      alpha_(std::max(leastAlpha, facets.alpha)),
      facetShare_(base_ == glm::dvec3(0.0) ? 1.0 : 0.5),
      energy_(energy) {}

glm::dvec3 FacetReflection::value(const glm::dvec3& view, const glm::dvec3& light) const {
    if (!(view.z > 0.0 && light.z > 0.0)) return glm::dvec3(0.0);
    const glm::dvec3 half = glm::normalize(view + light);
    const double shadowed = 1.0 / (1.0 + lambda(view.z, alpha_) + lambda(light.z, alpha_));
    const glm::dvec3 fresnel = reflectance_ + (1.0 - reflectance_) * schlick(glm::dot(view, half));
    const glm::dvec3 once = fresnel * (distribution(half.z, alpha_) * shadowed / (4.0 * view.z));
    const glm::dvec2 energy = energy_.at(view.z, alpha_);
    const glm::dvec3 again = 1.0 + reflectance_ * (1.0 / (energy.x + energy.y) - 1.0);
    const glm::dvec3 left = 1.0 - (reflectance_ * energy.x + energy.y) * again;
    return once * again + base_ * left * (light.z / pi);
}

glm::dvec3 FacetReflection::sample(const glm::dvec3& view, Random& random) const {
    const bool facet = random.uniform() < facetShare_;
    const double u = random.uniform(), v = random.uniform();
    if (facet) {
        const glm::dvec3 half = seenNormal(view, alpha_, u, v);
        return 2.0 * glm::dot(view, half) * half - view;
    }
    const double radius = std::sqrt(u), angle = 2.0 * pi * v;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1.0 - u)};
}

double FacetReflection::density(const glm::dvec3& view, const glm::dvec3& light) const {
    if (!(view.z > 0.0 && light.z > 0.0)) return 0.0;
    const glm::dvec3 half = glm::normalize(view + light);
    const double facets = distribution(half.z, alpha_) / ((1.0 + lambda(view.z, alpha_)) * 4.0 * view.z);
    return facetShare_ * facets + (1.0 - facetShare_) * light.z / pi;
}

}  // namespace lumulus::reference
