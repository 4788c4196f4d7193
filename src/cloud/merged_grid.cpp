#include "cloud/merged_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <limits>
#include <tuple>

#include "shared/world.h"

namespace lumulus::cloud {

namespace {

/// Voxels of the finest cloud along a cell: about 48 m for voxels of 8 m, at which walks through fields took least
/// time.
constexpr double voxelsInCell = 6.0;
/// 64 MiB of cells, and 32 MiB of bricks.
constexpr double mostCells = 8.0 * 1024 * 1024, mostBricks = 8.0 * 1024 * 1024;
/// Room for the rounding of places to single precision, voxels, and of sums of majorants.
constexpr double roundedVoxels = 1e-2;
constexpr float slack = 1.0F + 1e-5F;

using shared::MERGED_BRICK;

struct Entry {
    glm::ivec3 cell;
    std::uint32_t instance;
    float majorant;  // [1/m]
};

/// The largest block majorant between two places in voxels; 0 beside the volume.
float majorantWithin(const Asset& asset, const glm::dvec3& lower, const glm::dvec3& upper) {
    const glm::dvec3 size(asset.size);
    if (glm::any(glm::greaterThanEqual(lower, size)) || glm::any(glm::lessThanEqual(upper, glm::dvec3(0.0))))
        return 0.0F;
    const MajorantGrid& blocks = asset.blocks;
    const glm::dvec3 low = glm::max(lower, glm::dvec3(0.0)), high = glm::min(upper, size - 1e-6);
    float largest = 0.0F;
    const glm::ivec3 first(glm::floor(low / glm::dvec3(blocks.cellSize)));
    const glm::ivec3 last = glm::min(glm::ivec3(glm::floor(high / glm::dvec3(blocks.cellSize))), blocks.cells - 1);
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                largest = std::max(
                    largest, blocks.maxima[static_cast<std::size_t>((z * blocks.cells.y + y) * blocks.cells.x + x)]);
    return largest;
}

/// Half the extent of the box round a transformed box whose extents are halved too.
glm::dvec3 reachOf(const glm::dmat3& matrix, const glm::dvec3& half) {
    return glm::abs(matrix[0]) * half.x + glm::abs(matrix[1]) * half.y + glm::abs(matrix[2]) * half.z;
}

/// The cells in which a cloud has density.
std::vector<Entry> cellsOf(const MergedGrid& grid, const MergedSource& cloud, std::uint32_t instance) {
    const glm::dmat3 toVoxel = glm::inverse(cloud.voxelToMetres);
    const glm::dvec3 half = 0.5 * glm::dvec3(cloud.asset->size);
    const glm::dvec3 middle = cloud.origin + cloud.voxelToMetres * half - grid.origin;
    const glm::dvec3 reach = reachOf(cloud.voxelToMetres, half);
    const glm::dvec3 inCell = reachOf(toVoxel, glm::dvec3(0.5 * grid.edge)) + roundedVoxels;
    const glm::ivec3 first = glm::max(glm::ivec3(glm::floor((middle - reach) / grid.edge)), 0);
    const glm::ivec3 last =
        glm::min(glm::ivec3(glm::floor((middle + reach) / grid.edge)), grid.bricks * MERGED_BRICK - 1);
    std::vector<Entry> entries;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const glm::ivec3 cell(x, y, z);
                const glm::dvec3 voxel = toVoxel * ((glm::dvec3(cell) + 0.5) * grid.edge + grid.origin - cloud.origin);
                const float majorant = majorantWithin(*cloud.asset, voxel - inCell, voxel + inCell);
                if (majorant > 0.0F)
                    entries.push_back({cell, instance, slack * majorant * static_cast<float>(cloud.extinction)});
            }
    return entries;
}

std::size_t placeIn(const glm::ivec3& extent, const glm::ivec3& at) {
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(extent.y) + static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(extent.x) +
           static_cast<std::size_t>(at.x);
}

/// How far it is from each empty cell of a brick to one that is not, or out of the brick: negative, as walks have it.
void addDistances(std::span<glm::uvec2> cells) {
    MajorantGrid brick;
    brick.cells = glm::ivec3(MERGED_BRICK);
    for (const glm::uvec2& cell : cells) brick.maxima.push_back(std::bit_cast<float>(cell.x));
    const std::vector<float> values = majorantsAndDistances(brick);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (values[i] > 0.0F) continue;
        const int n = static_cast<int>(i);
        const glm::ivec3 at(n % MERGED_BRICK, n / MERGED_BRICK % MERGED_BRICK, n / (MERGED_BRICK * MERGED_BRICK));
        const int outside = glm::compMin(glm::min(at, MERGED_BRICK - 1 - at)) + 1;
        cells[i] = {std::bit_cast<std::uint32_t>(std::max(values[i], -static_cast<float>(outside))), 0U};
    }
}

/// Lists and sums of the entries, which are in order of brick and cell.
void fillCells(MergedGrid& grid, std::span<const Entry> entries) {
    for (std::size_t i = 0; i < entries.size();) {
        const glm::ivec3& at = entries[i].cell;
        std::size_t end = i;
        float sum = 0.0F;
        while (end < entries.size() && entries[end].cell == at) sum += entries[end++].majorant;
        const std::size_t brick = grid.numbers[placeIn(grid.bricks, at / MERGED_BRICK)];
        glm::uvec2& cell =
            grid.cells[brick * shared::MERGED_BRICK_CELLS + placeIn(glm::ivec3(MERGED_BRICK), at % MERGED_BRICK)];
        cell.x = std::bit_cast<std::uint32_t>(end - i > 1 ? slack * sum : sum);
        cell.y =
            end - i > 1 ? static_cast<std::uint32_t>(grid.lists.size()) : shared::SINGLE_INSTANCE + entries[i].instance;
        if (end - i > 1) {
            grid.lists.push_back(static_cast<std::uint32_t>(end - i));
            for (std::size_t k = i; k < end; ++k) grid.lists.push_back(entries[k].instance);
        }
        i = end;
    }
}

/// Distances of the bricks that have no cells.
void finishBricks(MergedGrid& grid) {
    MajorantGrid occupied;
    occupied.cells = grid.bricks;
    for (const std::uint32_t number : grid.numbers)
        occupied.maxima.push_back(number == shared::EMPTY_BRICK ? 0.0F : 1.0F);
    const std::vector<float> values = majorantsAndDistances(occupied);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] < 0.0F) grid.numbers[i] = shared::EMPTY_BRICK + static_cast<std::uint32_t>(-values[i]);
}

}  // namespace

double mergedCellEdge(std::span<const MergedSource> clouds, const glm::dvec3& lower, const glm::dvec3& upper) {
    double finest = std::numeric_limits<double>::infinity(), volume = 0.0;
    for (const MergedSource& cloud : clouds) {
        const double voxel = std::abs(glm::determinant(cloud.voxelToMetres));
        finest = std::min(finest, std::cbrt(voxel));
        volume += voxel * glm::compMul(glm::dvec3(cloud.asset->size));
    }
    const double box = glm::compMul(upper - lower) / std::pow(MERGED_BRICK, 3);
    return std::max({voxelsInCell * finest, std::cbrt(volume / mostCells), std::cbrt(box / mostBricks)});
}

MergedGrid mergeGrids(std::span<const MergedSource> clouds, const glm::dvec3& lower, const glm::dvec3& upper,
                      double edge) {
    MergedGrid grid;
    grid.origin = lower;
    grid.edge = edge;
    grid.bricks = glm::max(glm::ivec3(glm::ceil((upper - lower) / (edge * MERGED_BRICK))), 1);
    std::vector<std::vector<Entry>> each(clouds.size());
    tbb::parallel_for(std::size_t{0}, clouds.size(),
                      [&](std::size_t i) { each[i] = cellsOf(grid, clouds[i], static_cast<std::uint32_t>(i)); });
    std::vector<Entry> entries;
    for (const std::vector<Entry>& some : each) entries.insert(entries.end(), some.begin(), some.end());
    const auto key = [&](const Entry& e) {
        return std::tuple(placeIn(grid.bricks, e.cell / MERGED_BRICK),
                          placeIn(glm::ivec3(MERGED_BRICK), e.cell % MERGED_BRICK), e.instance);
    };
    std::ranges::sort(entries, [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
    grid.numbers.assign(placeIn(grid.bricks, {0, 0, grid.bricks.z}), shared::EMPTY_BRICK);
    std::uint32_t bricks = 0;
    for (const Entry& entry : entries) {
        std::uint32_t& number = grid.numbers[placeIn(grid.bricks, entry.cell / MERGED_BRICK)];
        if (number == shared::EMPTY_BRICK) number = bricks++;
    }
    grid.cells.assign(std::size_t{bricks} * shared::MERGED_BRICK_CELLS, glm::uvec2(0U));
    fillCells(grid, entries);
    for (std::size_t brick = 0; brick < bricks; ++brick)
        addDistances(std::span(grid.cells).subspan(brick * shared::MERGED_BRICK_CELLS, shared::MERGED_BRICK_CELLS));
    finishBricks(grid);
    return grid;
}

}  // namespace lumulus::cloud
