#include "surface/mesh/sun_field.h"

#include <algorithm>
#include <utility>

namespace lumulus::surface {
namespace {

glm::i64vec3 cornerOf(const glm::i64vec3& first, int corner) {
    return first + glm::i64vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
}

}  // namespace

std::size_t SunField::Hash::operator()(const glm::i64vec3& corner) const {
    auto hash = static_cast<std::uint64_t>(corner.x) * 0x9E3779B97F4A7C15ULL ^
                static_cast<std::uint64_t>(corner.y) * 0xC2B2AE3D27D4EB4FULL ^
                static_cast<std::uint64_t>(corner.z) * 0x165667B19E3779F9ULL;
    return hash ^ (hash >> 29U);
}

SunField::SunField(double cell, std::optional<double> lowest, SunIrradiance irradiance)
    : cell_(cell), lowest_(lowest), irradiance_(std::move(irradiance)) {}

std::vector<glm::dvec3> SunField::at(std::span<const glm::dvec3> points) {
    std::vector<glm::i64vec3> wanted;
    std::vector<glm::dvec3> places;
    for (const glm::dvec3& point : points) {
        const glm::i64vec3 first(glm::floor(point / cell_));
        for (int i = 0; i < 8; ++i) {
            const glm::i64vec3 corner = cornerOf(first, i);
            if (!known_.try_emplace(corner, glm::dvec3(0.0)).second) continue;
            wanted.push_back(corner);
            places.push_back(cell_ * glm::dvec3(corner));
            if (lowest_) places.back().y = std::max(places.back().y, *lowest_);
        }
    }
    const std::vector<glm::dvec3> found = wanted.empty() ? std::vector<glm::dvec3>() : irradiance_(places);
    for (std::size_t i = 0; i < wanted.size(); ++i) known_[wanted[i]] = found[i];
    std::vector<glm::dvec3> result;
    result.reserve(points.size());
    for (const glm::dvec3& point : points) {
        const glm::dvec3 place = point / cell_, first = glm::floor(place), share = place - first;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 side(i & 1, (i >> 1) & 1, i >> 2);
            const glm::dvec3 weight = side * share + (1.0 - side) * (1.0 - share);
            sum += weight.x * weight.y * weight.z * known_.at(cornerOf(glm::i64vec3(first), i));
        }
        result.push_back(sum);
    }
    return result;
}

}  // namespace lumulus::surface
