#include "volume/far_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/error.h"
#include "vdb/load_sparse.h"

namespace lumulus {
namespace {

using Part = std::array<glm::ivec3, 2>;
using Leaf = vdb::LeafTable::Leaf;

/// A box of fewer voxels is no trouble, and one of which more is filled is no better in parts.
constexpr double fewestVoxels = 16777216.0, mostFilled = 1.0 / 32.0;
/// Boxes of the parts have this share of the whole box at most.
constexpr double mostOfBox = 1.0 / 8.0;
/// Empty leaves between two parts at least.
constexpr int narrowestGap = 16;
constexpr std::size_t mostParts = 16;

/// Of leaves, first and last.
Part boxOf(std::span<const Leaf> leaves) {
    Part box{leaves.front().at, leaves.front().at};
    for (const Leaf& leaf : leaves) {
        box[0] = glm::min(box[0], leaf.at);
        box[1] = glm::max(box[1], leaf.at);
    }
    return box;
}

double sizeOf(const Part& box) {
    const glm::dvec3 extent = glm::dvec3(box[1] - box[0]) + 1.0;
    return extent.x * extent.y * extent.z;
}

/// Where the widest gap between leaves that are sorted along an axis ends; 0: there is none.
std::size_t afterGap(std::span<const Leaf> sorted, int axis, int& widest) {
    std::size_t found = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        const int gap = sorted[i].at[axis] - sorted[i - 1].at[axis] - 1;
        if (gap <= widest) continue;
        widest = gap;
        found = i;
    }
    return found;
}

/// Divides leaves at their widest gap, and what is left and right of it again. Reorders them.
void divide(std::span<Leaf> leaves, std::vector<Part>& parts, const Check& check) {
    check();
    int axis = -1, widest = narrowestGap - 1;
    for (int a = 0; a < 3; ++a) {
        std::ranges::stable_sort(leaves, {}, [a](const Leaf& leaf) { return leaf.at[a]; });
        if (afterGap(leaves, a, widest) > 0) axis = a;
    }
    if (axis < 0) {
        parts.push_back(boxOf(leaves));
        return;
    }
    std::ranges::stable_sort(leaves, {}, [axis](const Leaf& leaf) { return leaf.at[axis]; });
    int gap = 0;
    const std::size_t second = afterGap(leaves, axis, gap);
    divide(leaves.first(second), parts, check);
    divide(leaves.subspan(second), parts, check);
}

/// The parts of a cloud's file; none where it is better as it is.
std::vector<Part> partsOf(const scene::Cloud& cloud, double treeMiB, const Check& check) {
    const vdb::LoadOptions options{.grid = cloud.grid, .clamp = cloud.clamp, .limits = {check, treeMiB}};
    const vdb::GridOutline outline = vdb::outline(cloud.vdb, options);
    constexpr double voxelsPerMiB = 524288.0;
    if (outline.denseMiB * voxelsPerMiB < fewestVoxels || outline.filled > mostFilled) return {};
    vdb::SparseResult read = vdb::loadSparse(cloud.vdb, options);
    std::vector<Leaf>& leaves = read.volume.leaves.leaves;
    if (leaves.empty()) return {};
    std::vector<Part> parts;
    divide(leaves, parts, check);
    if (parts.size() < 2 || parts.size() > mostParts) return {};
    double sum = 0.0;
    for (const Part& part : parts) sum += sizeOf(part);
    if (sum > mostOfBox * sizeOf(boxOf(leaves))) return {};
    const glm::ivec3 first(glm::round(read.voxelToGrid.translation + 0.5));
    for (Part& part : parts)
        part = {first + vdb::LeafTable::edge * part[0], first + vdb::LeafTable::edge * (part[1] + 1) - 1};
    return parts;
}

}  // namespace

scene::Scene divideFarParts(scene::Scene scene, const Check& check) {
    constexpr double treesPerBudget = 8.0;
    std::vector<scene::Cloud> divided;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const scene::Cloud& cloud = scene.clouds[i];
        std::vector<Part> parts;
        const bool mayBe = !cloud.vdb.empty() && !cloud.voxels && !cloud.moment && !cloud.part;
        // of a table of instances one file would be looked at, and divided, for each of them
        const auto sharesFile = [&](const scene::Cloud& other) { return other.vdb == cloud.vdb; };
        if (mayBe && std::ranges::count_if(scene.clouds, sharesFile) == 1) try {
                parts = partsOf(cloud, treesPerBudget * scene.preparation.memoryBudget, check);
            } catch (const InputError&) {  // loading tells
            }
        const std::string name = scene::nameOf(scene, i);
        if (parts.empty()) {
            divided.push_back(cloud);
            divided.back().name = name;
        }
        for (std::size_t part = 0; part < parts.size(); ++part) {
            divided.push_back(cloud);
            divided.back().name = fmt::format("{}[{}]", name, part);
            divided.back().part = parts[part];
        }
    }
    if (divided.size() > scene.clouds.size()) scene.clouds = std::move(divided);
    return scene;
}

}  // namespace lumulus
