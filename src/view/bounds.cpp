#include "view/bounds.h"

#include <algorithm>
#include <limits>

#include "vdb/sparse_volume.h"
#include "view/filled_voxels.h"

namespace lumulus {

std::array<glm::dvec3, 8> Bounds::corners() const {
    std::array<glm::dvec3, 8> result;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const glm::dvec3 sign(i & 1U ? 1.0 : -1.0, i & 2U ? 1.0 : -1.0, i & 4U ? 1.0 : -1.0);
        result[i] = centre + halfAxes * sign;
    }
    return result;
}

double Bounds::radius() const {
    double result = 0.0;
    for (const glm::dvec3& corner : corners()) result = std::max(result, glm::distance(corner, centre));
    return result;
}

namespace {

/// Voxels that are not zero: lowest and highest corner.
struct VoxelBox {
    glm::ivec3 low{std::numeric_limits<int>::max()};
    glm::ivec3 high{0};

    bool filled() const { return low.x < high.x; }

    void add(const VoxelBox& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
};

/// The filled part of the row of voxels at (y, z).
VoxelBox filledRow(const vdb::Volume& volume, int y, int z) {
    const float* begin = volume.density.data() + volume.index(0, y, z);
    const float* end = begin + volume.size.x;
    const auto filled = [](float value) { return value > 0.0F; };
    const float* first = std::find_if(begin, end, filled);
    if (first == end) return {};
    const float* last = end;
    while (!filled(*(last - 1))) --last;
    return {{static_cast<int>(first - begin), y, z}, {static_cast<int>(last - begin), y + 1, z + 1}};
}

constexpr int edge = 4;  // of a bundle of rows
constexpr int leafEdge = vdb::LeafTable::edge;

/// The filled part of a bundle.
VoxelBox filledBundle(const vdb::Volume& volume, int y0, int z0) {
    VoxelBox bundle;
    for (int z = z0; z < std::min(z0 + edge, volume.size.z); ++z) {
        for (int y = y0; y < std::min(y0 + edge, volume.size.y); ++y) bundle.add(filledRow(volume, y, z));
    }
    return bundle;
}

/// A line of corners along x at (y, z): the extreme ones.
struct Line {
    int y, z, low, high;

    std::array<int, 2> place() const { return {y, z}; }
};

/// By place; each place once.
std::vector<Line> mergedLines(std::vector<Line> lines) {
    std::ranges::sort(lines, {}, &Line::place);
    std::vector<Line> merged;
    for (const Line& line : lines) {
        if (merged.empty() || merged.back().place() != line.place()) merged.push_back(line);
        merged.back().low = std::min(merged.back().low, line.low);
        merged.back().high = std::max(merged.back().high, line.high);
    }
    return merged;
}

/// The lines of all bundles that are filled.
std::vector<Line> outerLines(const vdb::Volume& volume, VoxelBox& all) {
    std::vector<Line> lines;
    for (int z = 0; z < volume.size.z; z += edge) {
        for (int y = 0; y < volume.size.y; y += edge) {
            const VoxelBox bundle = filledBundle(volume, y, z);
            if (!bundle.filled()) continue;
            all.add(bundle);
            for (const int atY : {bundle.low.y, bundle.high.y})
                for (const int atZ : {bundle.low.z, bundle.high.z})
                    lines.push_back({atY, atZ, bundle.low.x, bundle.high.x});
        }
    }
    return mergedLines(std::move(lines));
}

/// The lines of all rows of leaves.
std::vector<Line> outerLines(const vdb::SparseVolume& volume, VoxelBox& all) {
    std::vector<Line> lines;
    for (const vdb::LeafTable::Leaf& leaf : volume.leaves.leaves) {
        const VoxelBox box{leafEdge * leaf.at, leafEdge * (leaf.at + 1)};
        all.add(box);
        for (const int atY : {box.low.y, box.high.y})
            for (const int atZ : {box.low.z, box.high.z}) lines.push_back({atY, atZ, box.low.x, box.high.x});
    }
    return mergedLines(std::move(lines));
}

/// Ends of the lines that are no mean of their neighbours' and the other end: those others lie in the convex hull of
/// the rest, and whoever looks at the cloud's outline need not look at them.
std::vector<glm::ivec3> outerEnds(const std::vector<Line>& lines, int apart) {
    const auto find = [&](int y, int z) {
        const auto found = std::ranges::lower_bound(lines, std::array<int, 2>{y, z}, {}, &Line::place);
        return found != lines.end() && found->y == y && found->z == z ? &*found : nullptr;
    };
    std::vector<glm::ivec3> ends;
    for (const Line& line : lines) {
        bool low = true, high = true;
        for (const glm::ivec2 aside : {glm::ivec2(apart, 0), glm::ivec2(0, apart)}) {
            const Line* before = find(line.y - aside.x, line.z - aside.y);
            const Line* after = find(line.y + aside.x, line.z + aside.y);
            if (before == nullptr || after == nullptr) continue;
            low = low && before->low + after->low > 2 * line.low;
            high = high && before->high + after->high < 2 * line.high;
        }
        if (low) ends.emplace_back(line.low, line.y, line.z);
        if (high) ends.emplace_back(line.high, line.y, line.z);
    }
    return ends;
}

}  // namespace

FilledVoxels filledVoxels(const vdb::PlacedVolume& cloud) {
    const vdb::Volume& volume = *cloud.volume;
    FilledVoxels filled;
    VoxelBox all;
    filled.ends = cloud.bricks == nullptr ? outerEnds(outerLines(volume, all), edge)
                                          : outerEnds(outerLines(*cloud.bricks, all), leafEdge);
    if (!all.filled()) all = {glm::ivec3(0), volume.size};
    filled.low = all.low;
    filled.high = all.high;
    return filled;
}

Bounds boundsOf(const FilledVoxels& filled, const vdb::Affine& toWorld) {
    Bounds bounds;
    for (const glm::ivec3& corner : filled.ends) bounds.outline.push_back(toWorld.point(glm::dvec3(corner)));
    bounds.centre = toWorld.point(0.5 * glm::dvec3(filled.low + filled.high));
    const glm::dvec3 half = 0.5 * glm::dvec3(filled.high - filled.low);
    for (int axis = 0; axis < 3; ++axis) bounds.halfAxes[axis] = toWorld.linear[axis] * half[axis];
    return bounds;
}

Bounds boundsOf(const vdb::PlacedVolume& cloud) {
    return boundsOf(filledVoxels(cloud), cloud.toWorld);
}

Bounds unite(std::span<const Bounds> parts) {
    if (parts.empty()) return {};
    if (parts.size() == 1) return parts.front();
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    Bounds whole;
    for (const Bounds& part : parts) {
        const auto corners = part.corners();
        for (const glm::dvec3& corner : corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
        const std::span<const glm::dvec3> points = part.outline.empty() ? std::span(corners) : std::span(part.outline);
        whole.outline.insert(whole.outline.end(), points.begin(), points.end());
    }
    whole.centre = 0.5 * (low + high);
    const glm::dvec3 half = 0.5 * (high - low);
    whole.halfAxes = glm::dmat3(half.x, 0.0, 0.0, 0.0, half.y, 0.0, 0.0, 0.0, half.z);
    return whole;
}

Bounds boundsOf(std::span<const vdb::PlacedVolume> clouds) {
    std::vector<Bounds> parts;
    for (const vdb::PlacedVolume& cloud : clouds) parts.push_back(boundsOf(cloud));
    return unite(parts);
}

}  // namespace lumulus
