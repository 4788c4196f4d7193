#include "light/photon/entry_discs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumulus::photon {

namespace {

/// Room for rounding to single precision.
constexpr double slack = 1.0 + 1e-4;

/// Columns: areas of the parallelograms of two axes each, as vectors across them.
glm::dmat3 cofactors(const glm::dmat3& axes) {
    return {glm::cross(axes[1], axes[2]), glm::cross(axes[2], axes[0]), glm::cross(axes[0], axes[1])};
}

glm::vec4 row(const glm::dmat3& matrix, const glm::dvec3& fourth, int number) {
    return glm::vec4(glm::dvec4(matrix[0][number], matrix[1][number], matrix[2][number], fourth[number]));
}

/// A bound: axes of a sheared volume need not be those of its ellipsoid.
double longestAxis(const glm::dmat3& axes) {
    const double squares = glm::dot(axes[0], axes[0]) + glm::dot(axes[1], axes[1]) + glm::dot(axes[2], axes[2]);
    const double longest = std::max({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
    const double skew = std::abs(glm::dot(axes[0], axes[1])) + std::abs(glm::dot(axes[1], axes[2])) +
                        std::abs(glm::dot(axes[2], axes[0]));
    return skew < 1e-9 * squares ? longest : std::sqrt(squares);
}

}  // namespace

Ellipsoid ellipsoidOf(const cloud::Asset& asset) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const cloud::Collector& collector : asset.collectors) {
        lower = glm::min(lower, glm::dvec3(collector.box.lower));
        upper = glm::max(upper, glm::dvec3(collector.box.upper));
    }
    const glm::dvec3 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
    double farthest = 0.0;
    for (const cloud::Collector& collector : asset.collectors) {
        const glm::dvec3 a = glm::abs(glm::dvec3(collector.box.lower) - middle),
                         b = glm::abs(glm::dvec3(collector.box.upper) - middle);
        farthest = std::max(farthest, glm::length(glm::max(a, b) / half));
    }
    return {middle, slack * farthest * half};
}

double PlacedEllipsoid::largestArea() const {
    const glm::dmat3 c = cofactors(axes);
    return std::numbers::pi * std::sqrt(glm::dot(c[0], c[0]) + glm::dot(c[1], c[1]) + glm::dot(c[2], c[2]));
}

/// A quarter of the surface, by Thomsen's formula (1 % at most from it).
double PlacedEllipsoid::meanArea() const {
    constexpr double power = 1.6075;
    const glm::dmat3 c = cofactors(axes);
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += std::pow(glm::length(c[i]), power);
    return std::numbers::pi * std::pow(sum / 3.0, 1.0 / power);
}

glm::dvec3 PlacedEllipsoid::reach() const {
    glm::dvec3 squared(0.0);
    for (int i = 0; i < 3; ++i) squared += axes[i] * axes[i];
    return glm::sqrt(squared);
}

AliasTable makeAliasTable(std::span<const double> shares) {
    const std::size_t count = shares.size();
    AliasTable table{std::vector<double>(count, 1.0), std::vector<std::size_t>(count)};
    std::vector<double> left;
    std::vector<std::size_t> small, large;
    for (std::size_t i = 0; i < count; ++i) {
        table.other[i] = i;
        left.push_back(shares[i] * static_cast<double>(count));
        (left[i] < 1.0 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::size_t less = small.back(), more = large.back();
        small.pop_back();
        table.keep[less] = left[less];
        table.other[less] = more;
        left[more] -= 1.0 - left[less];
        if (left[more] >= 1.0) continue;
        large.pop_back();
        small.push_back(more);
    }
    return table;
}

std::vector<shared::EntryDisc> entryDiscs(std::span<const PlacedEllipsoid> ellipsoids, std::span<const double> shares,
                                          const glm::dvec3& corner) {
    const AliasTable alias = makeAliasTable(shares);
    std::vector<shared::EntryDisc> discs(ellipsoids.size());
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const glm::dmat3& axes = ellipsoids[i].axes;
        const glm::dvec3 middle = ellipsoids[i].middle - corner;
        const glm::dmat3 toUnit = glm::inverse(axes);
        for (int axis = 0; axis < 3; ++axis) {
            discs[i].toUnit[axis] = row(toUnit, -(toUnit * middle), axis);
            discs[i].fromUnit[axis] = row(axes, middle, axis);
        }
        discs[i].sphere = glm::vec4(glm::vec3(middle), static_cast<float>(slack * longestAxis(axes)));
        discs[i].volume = static_cast<float>(std::numbers::pi * std::abs(glm::determinant(axes)));
        discs[i].share = static_cast<float>(shares[i]);
        discs[i].keep = static_cast<float>(alias.keep[i]);
        discs[i].other = static_cast<float>(alias.other[i]);
    }
    return discs;
}

}  // namespace lumulus::photon
