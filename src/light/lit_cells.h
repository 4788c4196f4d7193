#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lumulus::light {

/// The cells of a grid in which light is looked up: those with density, and those that touch one, if only at a corner,
/// since a linear look-up in the one reaches the other.
struct LitCells {
    std::vector<std::uint32_t> numbers;  ///< x fastest: the ones with density rising, then the others rising
    std::uint32_t occupied = 0;          ///< cells with density
};

/// `mass`: of each of the grid's cells, x fastest.
LitCells litCells(const glm::ivec3& cells, std::span<const float> mass);

}  // namespace lumulus::light
