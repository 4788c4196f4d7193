#include "surface/material/energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace lumulus::material {

namespace {

constexpr double lowest = 1e-4;  // cosine of the view at grazing incidence

}  // namespace

SplitSum splitSum(Microfacets kind, double cosView, double alpha, std::uint32_t points) {
    const double c = std::max(cosView, lowest);
    const glm::dvec3 view(std::sqrt(std::max(0.0, 1.0 - c * c)), 0.0, c);
    SplitSum sum;
    for (std::uint32_t i = 0; i < points; ++i) {
        const glm::dvec2 u = spreadPoint(i, points);
        const bool seen = kind == Microfacets::ggx;
        const glm::dvec3 half = seen ? sampleSeenNormal(view, alpha, u) : sampleNormal(kind, alpha, u);
        const double cosHalf = glm::dot(view, half), cosLight = 2.0 * cosHalf * half.z - view.z;
        if (!(cosLight > 0.0 && cosHalf > 0.0)) continue;
        // reflected / density, both without Fresnel's term
        const double v = visibility(kind, cosLight, c, alpha);
        const double weight =
            seen ? 4.0 * v * cosLight * c / unhidden(kind, c, alpha) : 4.0 * v * cosLight * cosHalf / half.z;
        const double rest = fresnel(glm::dvec3(0.0), cosHalf).x;
        sum.scale += weight * (1.0 - rest) / points;
        sum.bias += weight * rest / points;
    }
    return sum;
}

EnergyTable::EnergyTable(Microfacets kind) : kind_(kind), values_(static_cast<std::size_t>(nodes_ * nodes_)) {
    tbb::parallel_for(0, nodes_, [&](int row) {
        for (int column = 0; column < nodes_; ++column)
            values_[static_cast<std::size_t>(row * nodes_ + column)] =
                splitSum(kind, std::pow(column / (nodes_ - 1.0), 2), std::pow(row / (nodes_ - 1.0), 2));
    });
}

SplitSum EnergyTable::at(double cosView, double alpha) const {
    const auto place = [](double value) { return std::sqrt(std::clamp(value, 0.0, 1.0)) * (nodes_ - 1.0); };
    const double x = place(cosView), y = place(alpha);
    const int column = std::min(static_cast<int>(x), nodes_ - 2), row = std::min(static_cast<int>(y), nodes_ - 2);
    const double right = x - column, down = y - row;
    SplitSum result;
    for (const auto& [i, share] : {std::pair{row * nodes_ + column, (1.0 - right) * (1.0 - down)},
                                   std::pair{row * nodes_ + column + 1, right * (1.0 - down)},
                                   std::pair{(row + 1) * nodes_ + column, (1.0 - right) * down},
                                   std::pair{(row + 1) * nodes_ + column + 1, right * down}}) {
        result.scale += share * values_[static_cast<std::size_t>(i)].scale;
        result.bias += share * values_[static_cast<std::size_t>(i)].bias;
    }
    return result;
}

}  // namespace lumulus::material
