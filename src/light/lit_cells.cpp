#include "light/lit_cells.h"

namespace lumulus::light {

namespace {

/// Marks what is beside a marked cell along one axis too.
std::vector<char> spread(const std::vector<char>& marked, const glm::ivec3& cells, int axis) {
    const std::size_t stride = axis == 0   ? 1
                               : axis == 1 ? static_cast<std::size_t>(cells.x)
                                           : static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y);
    const auto length = static_cast<std::size_t>(cells[axis]);
    std::vector<char> result = marked;
    for (std::size_t first = 0; first < marked.size(); first += stride * length)
        for (std::size_t i = first; i < first + stride * (length - 1); ++i) {
            result[i] = static_cast<char>(result[i] | marked[i + stride]);
            result[i + stride] = static_cast<char>(result[i + stride] | marked[i]);
        }
    return result;
}

}  // namespace

LitCells litCells(const glm::ivec3& cells, std::span<const float> mass) {
    LitCells result;
    std::vector<char> near(mass.size());
    for (std::size_t i = 0; i < mass.size(); ++i) {
        near[i] = mass[i] > 0.0F ? 1 : 0;
        if (near[i] != 0) result.numbers.push_back(static_cast<std::uint32_t>(i));
    }
    result.occupied = static_cast<std::uint32_t>(result.numbers.size());
    for (int axis = 0; axis < 3; ++axis) near = spread(near, cells, axis);
    for (std::size_t i = 0; i < mass.size(); ++i)
        if (near[i] != 0 && !(mass[i] > 0.0F)) result.numbers.push_back(static_cast<std::uint32_t>(i));
    return result;
}

}  // namespace lumulus::light
