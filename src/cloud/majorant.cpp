#include <algorithm>

#include "cloud/asset.h"

namespace lumulus::cloud {

namespace {

/// Room for the rounding of the interpolation hardware.
constexpr float slack = 1.0F + 1e-5F;

void countNullCollisions(MajorantGrid& grid, const glm::ivec3& size, double mass) {
    const auto index = [](const glm::ivec3& at, const glm::ivec3& extent) {
        return static_cast<std::size_t>((at.z * extent.y + at.y) * extent.x + at.x);
    };
    double tentative = 0.0;
    for (int z = 0; z < grid.cells.z; ++z)
        for (int y = 0; y < grid.cells.y; ++y)
            for (int x = 0; x < grid.cells.x; ++x) {
                const glm::ivec3 cell(x, y, z);
                const glm::dvec3 lower = glm::dvec3(cell) * glm::dvec3(grid.cellSize);
                const glm::dvec3 upper = glm::min(lower + glm::dvec3(grid.cellSize), glm::dvec3(size));
                const glm::dvec3 extent = upper - lower;
                tentative += static_cast<double>(grid.maxima[index(cell, grid.cells)]) * extent.x * extent.y * extent.z;
            }
    grid.nullCollisions = std::max(0.0, tentative / mass - 1.0);
}

}  // namespace

std::vector<float> majorantsAndDistances(const MajorantGrid& grid) {
    std::vector<float> values = grid.maxima;
    const glm::ivec3 n = grid.cells;
    std::vector<int> distance(values.size());
    const int far = n.x + n.y + n.z;
    const auto at = [&](int x, int y, int z) { return static_cast<std::size_t>((z * n.y + y) * n.x + x); };
    for (std::size_t i = 0; i < values.size(); ++i) distance[i] = values[i] > 0.0F ? 0 : far;
    const auto pass = [&](int sign) {
        const glm::ivec3 first = sign > 0 ? glm::ivec3(0) : n - 1;
        for (int z = first.z; z >= 0 && z < n.z; z += sign)
            for (int y = first.y; y >= 0 && y < n.y; y += sign)
                for (int x = first.x; x >= 0 && x < n.x; x += sign) {
                    int& own = distance[at(x, y, z)];
                    for (int k = 0; k < 13 && own > 0; ++k) {
                        const int X = x + sign * (k % 3 - 1), Y = y + sign * ((k / 3) % 3 - 1),
                                  Z = z + sign * (k / 9 - 1);
                        if (X < 0 || Y < 0 || Z < 0 || X >= n.x || Y >= n.y || Z >= n.z) continue;
                        own = std::min(own, distance[at(X, Y, Z)] + 1);
                    }
                }
    };
    pass(1);
    pass(-1);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (distance[i] > 0) values[i] = -static_cast<float>(distance[i]);
    return values;
}

MajorantGrid majorantGrid(const std::vector<float>& blockMaxima, const glm::ivec3& blocks, const glm::ivec3& size,
                          int edge, double mass) {
    MajorantGrid grid;
    const bool global = edge == 0;
    grid.cells = global ? glm::ivec3(1) : (blocks + edge - 1) / edge;
    grid.cellSize = global ? glm::vec3(size) : glm::vec3(static_cast<float>(edge * shared::BLOCK_EDGE));
    const auto index = [](const glm::ivec3& at, const glm::ivec3& extent) {
        return static_cast<std::size_t>((at.z * extent.y + at.y) * extent.x + at.x);
    };
    grid.maxima.assign(static_cast<std::size_t>(grid.cells.x * grid.cells.y * grid.cells.z), 0.0F);
    for (int z = 0; z < blocks.z; ++z)
        for (int y = 0; y < blocks.y; ++y)
            for (int x = 0; x < blocks.x; ++x) {
                const glm::ivec3 block(x, y, z);
                float& cell = grid.maxima[index(global ? glm::ivec3(0) : block / edge, grid.cells)];
                cell = std::max(cell, slack * blockMaxima[index(block, blocks)]);
            }
    countNullCollisions(grid, size, mass);
    return grid;
}

MajorantGrid majorantGrid(const vdb::SparseVolume& volume, bool global, double mass) {
    MajorantGrid grid;
    grid.cells = global ? glm::ivec3(1) : volume.cells();
    grid.cellSize = global ? glm::vec3(volume.size)
                           : glm::vec3(static_cast<float>(volume.cellBricks * vdb::SparseVolume::brickEdge));
    if (global)
        grid.maxima = {*std::ranges::max_element(volume.cellMajorants)};
    else
        grid.maxima = volume.cellMajorants;
    for (float& majorant : grid.maxima) majorant *= slack;
    countNullCollisions(grid, volume.size, mass);
    return grid;
}

}  // namespace lumulus::cloud
