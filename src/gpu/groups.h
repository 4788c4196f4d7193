#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

namespace lumulus::gpu {

/// Workgroups for `count` items, folded into two axes since one axis holds only 65,535 of them on some devices.
/// The shader finds its item by lib/linear.glsl.
inline glm::uvec3 linearGroups(std::uint64_t count, std::uint32_t itemsPerGroup) {
    constexpr std::uint64_t row = 32768;
    const std::uint64_t groups = std::max<std::uint64_t>(1, (count + itemsPerGroup - 1) / itemsPerGroup);
    return {static_cast<std::uint32_t>(std::min(groups, row)), static_cast<std::uint32_t>((groups + row - 1) / row), 1};
}

/// Workgroups of 16 × 4 invocations, one invocation for each pixel.
inline glm::uvec3 pixelGroups(const glm::ivec2& size) {
    return {(static_cast<std::uint32_t>(size.x) + 15) / 16, (static_cast<std::uint32_t>(size.y) + 3) / 4, 1};
}

}  // namespace lumulus::gpu
