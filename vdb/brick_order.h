#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lumulus::vdb {

/// An order of bricks: region by region of 16³, and within one by Morton's curve, so that all bricks of a cube of 2, 4
/// or 8 along each axis follow each other (inside vdb/ only).
class BrickOrder {
  public:
    static constexpr int regionEdge = 16;

    explicit BrickOrder(const glm::ivec3& bricks) : regions_((bricks + regionEdge - 1) / regionEdge) {}

    std::uint64_t keyOf(const glm::ivec3& brick) const {
        const glm::u64vec3 region(brick / regionEdge), extent(regions_);
        const std::uint64_t number = region.x + extent.x * (region.y + extent.y * region.z);
        const glm::uvec3 within(brick % regionEdge);
        return number << 12U | spread(within.x) | spread(within.y) << 1U | spread(within.z) << 2U;
    }

    glm::ivec3 brickOf(std::uint64_t key) const {
        const glm::u64vec3 extent(regions_);
        const std::uint64_t number = key >> 12U;
        const glm::u64vec3 region(number % extent.x, number / extent.x % extent.y, number / (extent.x * extent.y));
        const auto code = static_cast<std::uint32_t>(key & 0xFFFU);
        return regionEdge * glm::ivec3(region) + glm::ivec3(gathered(code), gathered(code >> 1U), gathered(code >> 2U));
    }

  private:
    /// Bit i of four to bit 3i.
    static std::uint64_t spread(std::uint32_t bits) {
        return (bits & 1U) | (bits & 2U) << 2U | (bits & 4U) << 4U | (bits & 8U) << 6U;
    }
    static std::uint32_t gathered(std::uint32_t code) {
        return (code & 1U) | (code >> 2U & 2U) | (code >> 4U & 4U) | (code >> 6U & 8U);
    }

    glm::ivec3 regions_;
};

}  // namespace lumulus::vdb
