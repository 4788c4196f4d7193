#include "vdb/bumps.h"

#include <algorithm>

#include "vdb/noise.h"

namespace lumulus::vdb {
namespace {

// A sphere of a cell beyond the eight nearest ones lies at least 1.5 − 0.5 − jitter from the point: it cannot reach it.
constexpr float kJitter = 0.22F;            ///< largest shift from the middle of the cell along an axis
constexpr float kLargest = 1.0F - kJitter;  ///< largest radius, cells
constexpr float kSmallest = 0.50F;

}  // namespace

void BumpTable::cover(const glm::vec3& low, const glm::vec3& high, std::uint32_t seed) {
    constexpr float rounding = 1e-3F;
    origin_ = glm::ivec3(glm::floor(low - 0.5F - rounding));
    size_ = glm::ivec3(glm::floor(high - 0.5F + rounding)) + 2 - origin_;
    spheres_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                    static_cast<std::size_t>(size_.z));
    auto next = spheres_.begin();
    for (int z = 0; z < size_.z; ++z) {
        for (int y = 0; y < size_.y; ++y) {
            for (int x = 0; x < size_.x; ++x) {
                const glm::ivec3 cell(x, y, z);
                const std::uint32_t h = hashCell(origin_ + cell, seed);
                const glm::uvec3 bytes(h & 255U, (h >> 8U) & 255U, (h >> 16U) & 255U);
                const glm::vec3 shift = (glm::vec3(bytes) / 127.5F - 1.0F) * kJitter;
                const float radius = kSmallest + (kLargest - kSmallest) * static_cast<float>(h >> 24U) / 255.0F;
                *next++ = {glm::vec3(cell) + 0.5F + shift, radius * radius};
            }
        }
    }
}

float BumpTable::at(const glm::vec3& point) const {
    const glm::vec3 p = point - glm::vec3(origin_);
    const int x = static_cast<int>(p.x - 0.5F), y = static_cast<int>(p.y - 0.5F), z = static_cast<int>(p.z - 0.5F);
    const auto row = static_cast<std::size_t>(size_.x);
    const auto slice = row * static_cast<std::size_t>(size_.y);
    const Sphere* nearest = &spheres_[static_cast<std::size_t>(z) * slice + static_cast<std::size_t>(y) * row +
                                      static_cast<std::size_t>(x)];
    float most = 0.0F;
    for (const std::size_t corner : {std::size_t{0}, row, slice, slice + row}) {
        for (const Sphere* sphere = nearest + corner; sphere != nearest + corner + 2; ++sphere) {
            const glm::vec3 d = p - sphere->centre;
            most = std::max(most, sphere->squaredRadius - glm::dot(d, d));
        }
    }
    return most * (1.0F / (kLargest * kLargest));
}

}  // namespace lumulus::vdb
