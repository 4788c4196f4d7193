#include "cloud/merged_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
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
/// Of each cloud, so that two that are far apart do not need all of them.
constexpr double bricksOfEach = 256.0 * 1024;
/// So many times as many cells as there would be if each cloud had cells for its own voxels: a speck beside clouds does
/// not ask for cells of its size everywhere.
constexpr double finerCells = 64.0;
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

/// Which cells of a brick and of those around it have density: a bit each along x, in rows along y and z.
using Rows = std::array<std::uint32_t, std::size_t{9} * MERGED_BRICK * MERGED_BRICK>;
constexpr int rowsAcross = 3 * MERGED_BRICK;
/// So far the bricks around one tell what is empty.
constexpr int farthest = MERGED_BRICK;

Rows occupiedAround(const MergedGrid& grid, const glm::ivec3& brick) {
    Rows rows{};
    for (int i = 0; i < 27; ++i) {
        const glm::ivec3 beside(i % 3, i / 3 % 3, i / 9), at = brick + beside - 1;
        if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, grid.bricks))) continue;
        const std::uint32_t number = grid.numbers[placeIn(grid.bricks, at)];
        if (number >= shared::EMPTY_BRICK) continue;
        for (int cell = 0; cell < shared::MERGED_BRICK_CELLS; ++cell) {
            const float value = std::bit_cast<float>(
                grid.cells[number * shared::MERGED_BRICK_CELLS + static_cast<std::size_t>(cell)].x);
            if (!(value > 0.0F)) continue;
            const glm::ivec3 within(cell % MERGED_BRICK, cell / MERGED_BRICK % MERGED_BRICK,
                                    cell / (MERGED_BRICK * MERGED_BRICK));
            const glm::ivec3 place = beside * MERGED_BRICK + within;
            rows[static_cast<std::size_t>(place.z * rowsAcross + place.y)] |= 1U << static_cast<unsigned>(place.x);
        }
    }
    return rows;
}

/// Each cell and those that touch it.
Rows grown(const Rows& rows) {
    Rows along{}, result{};
    for (int z = 0; z < rowsAcross; ++z)
        for (int y = 0; y < rowsAcross; ++y)
            for (int k = std::max(y - 1, 0); k <= std::min(y + 1, rowsAcross - 1); ++k) {
                const std::uint32_t row = rows[static_cast<std::size_t>(z * rowsAcross + k)];
                along[static_cast<std::size_t>(z * rowsAcross + y)] |= row | row << 1U | row >> 1U;
            }
    for (int z = 0; z < rowsAcross; ++z)
        for (int y = 0; y < rowsAcross; ++y)
            for (int k = std::max(z - 1, 0); k <= std::min(z + 1, rowsAcross - 1); ++k)
                result[static_cast<std::size_t>(z * rowsAcross + y)] |=
                    along[static_cast<std::size_t>(k * rowsAcross + y)];
    return result;
}

/// Of each empty cell of a brick how far it is to one that is not, as far as the bricks around it tell.
std::array<int, shared::MERGED_BRICK_CELLS> distancesIn(const MergedGrid& grid, const glm::ivec3& brick) {
    std::array<int, shared::MERGED_BRICK_CELLS> distances{};
    distances.fill(farthest + 1);
    Rows rows = occupiedAround(grid, brick);
    for (int distance = 0; distance <= farthest; ++distance) {
        for (int cell = 0; cell < shared::MERGED_BRICK_CELLS; ++cell) {
            const glm::ivec3 place = glm::ivec3(cell % MERGED_BRICK, cell / MERGED_BRICK % MERGED_BRICK,
                                                cell / (MERGED_BRICK * MERGED_BRICK)) +
                                     MERGED_BRICK;
            int& known = distances[static_cast<std::size_t>(cell)];
            const std::uint32_t row = rows[static_cast<std::size_t>(place.z * rowsAcross + place.y)];
            if (known > farthest && (row >> static_cast<unsigned>(place.x) & 1U) != 0U) known = distance;
        }
        rows = grown(rows);
    }
    return distances;
}

/// Distances of the empty cells: negative, as walks have it.
void addDistances(MergedGrid& grid) {
    std::vector<std::array<int, shared::MERGED_BRICK_CELLS>> distances(grid.cells.size() / shared::MERGED_BRICK_CELLS);
    tbb::parallel_for(std::size_t{0}, grid.numbers.size(), [&](std::size_t i) {
        if (grid.numbers[i] >= shared::EMPTY_BRICK) return;
        const int n = static_cast<int>(i);
        distances[grid.numbers[i]] = distancesIn(
            grid, {n % grid.bricks.x, n / grid.bricks.x % grid.bricks.y, n / (grid.bricks.x * grid.bricks.y)});
    });
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        const int distance = distances[i / shared::MERGED_BRICK_CELLS][i % shared::MERGED_BRICK_CELLS];
        if (distance > 0) grid.cells[i] = {std::bit_cast<std::uint32_t>(-static_cast<float>(distance)), 0U};
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
    double finest = std::numeric_limits<double>::infinity(), volume = 0.0, wanted = 0.0;
    for (const MergedSource& cloud : clouds) {
        const double voxel = std::abs(glm::determinant(cloud.voxelToMetres));
        const double voxels = glm::compMul(glm::dvec3(cloud.asset->size));
        finest = std::min(finest, std::cbrt(voxel));
        volume += voxel * voxels;
        wanted += voxels / std::pow(voxelsInCell, 3);
    }
    double edge =
        std::max({voxelsInCell * finest, std::cbrt(volume / (finerCells * wanted)), std::cbrt(volume / mostCells)});
    const double most = std::min(mostBricks, bricksOfEach * static_cast<double>(clouds.size()));
    // a flat box has one layer of bricks, however large they are
    const auto bricks = [&] { return glm::compMul(glm::max(glm::ceil((upper - lower) / (edge * MERGED_BRICK)), 1.0)); };
    while (bricks() > most) edge *= 1.1;
    return edge;
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
    addDistances(grid);
    finishBricks(grid);
    return grid;
}

}  // namespace lumulus::cloud
