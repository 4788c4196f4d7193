#include "light/photon/entry_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

namespace lumulus::photon {

namespace {

/// Cells at most, for each ellipsoid and of a grid of few.
constexpr double cellsOfEach = 16.0, fewestCells = 64.0;
/// Room for the rounding of places along a line to single precision, over a cell's edge.
constexpr double roundedEdges = 1e-3;

double edgeFor(std::span<const PlacedEllipsoid> ellipsoids, const glm::dvec3& extent) {
    double diameters = 0.0;
    for (const PlacedEllipsoid& one : ellipsoids) diameters += 2.0 * glm::compMax(one.reach());
    const auto count = static_cast<double>(ellipsoids.size());
    const double least = std::cbrt(glm::compMul(extent) / (cellsOfEach * count + fewestCells));
    return std::max(diameters / count, least);
}

}  // namespace

EntryGrid makeEntryGrid(std::span<const PlacedEllipsoid> ellipsoids, const glm::dvec3& lower, const glm::dvec3& upper) {
    EntryGrid grid;
    grid.edge = edgeFor(ellipsoids, upper - lower);
    grid.cells = glm::max(glm::ivec3(glm::ceil((upper - lower) / grid.edge)), 1);
    std::vector<std::vector<std::uint32_t>> each(static_cast<std::size_t>(glm::compMul(grid.cells)));
    for (std::size_t i = 0; i < ellipsoids.size(); ++i) {
        const glm::dvec3 middle = (ellipsoids[i].middle - lower) / grid.edge;
        const glm::dvec3 reach = ellipsoids[i].reach() / grid.edge + roundedEdges;
        const glm::ivec3 first = glm::clamp(glm::ivec3(glm::floor(middle - reach)), glm::ivec3(0), grid.cells - 1);
        const glm::ivec3 last = glm::clamp(glm::ivec3(glm::floor(middle + reach)), glm::ivec3(0), grid.cells - 1);
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x)
                    each[static_cast<std::size_t>((z * grid.cells.y + y) * grid.cells.x + x)].push_back(
                        static_cast<std::uint32_t>(i));
    }
    std::vector<std::uint32_t> numbers;
    for (const std::vector<std::uint32_t>& some : each) {
        grid.lists.push_back(static_cast<std::uint32_t>(each.size() + 1 + numbers.size()));
        numbers.insert(numbers.end(), some.begin(), some.end());
    }
    grid.lists.push_back(static_cast<std::uint32_t>(each.size() + 1 + numbers.size()));
    grid.lists.insert(grid.lists.end(), numbers.begin(), numbers.end());
    return grid;
}

}  // namespace lumulus::photon
