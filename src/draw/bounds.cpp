#include "draw/bounds.h"

#include <algorithm>
#include <limits>

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

    std::array<glm::dvec3, 8> corners() const {
        std::array<glm::dvec3, 8> result;
        for (unsigned i = 0; i < 8; ++i) {
            result[i] = {i & 1U ? high.x : low.x, i & 2U ? high.y : low.y, i & 4U ? high.z : low.z};
        }
        return result;
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

/// The filled part of a bundle of rows, `edge` by `edge`.
VoxelBox filledBundle(const vdb::Volume& volume, int y0, int z0, int edge) {
    VoxelBox bundle;
    for (int z = z0; z < std::min(z0 + edge, volume.size.z); ++z) {
        for (int y = y0; y < std::min(y0 + edge, volume.size.y); ++y) bundle.add(filledRow(volume, y, z));
    }
    return bundle;
}

}  // namespace

Bounds boundsOf(const vdb::Volume& volume) {
    constexpr int edge = 4;
    Bounds bounds;
    VoxelBox all;
    for (int z = 0; z < volume.size.z; z += edge) {
        for (int y = 0; y < volume.size.y; y += edge) {
            const VoxelBox bundle = filledBundle(volume, y, z, edge);
            if (!bundle.filled()) continue;
            all.add(bundle);
            for (const glm::dvec3& corner : bundle.corners()) bounds.outline.push_back(volume.toWorld.point(corner));
        }
    }
    if (!all.filled()) all = {glm::ivec3(0), volume.size};
    bounds.centre = volume.toWorld.point(0.5 * glm::dvec3(all.low + all.high));
    const glm::dvec3 half = 0.5 * glm::dvec3(all.high - all.low);
    for (int axis = 0; axis < 3; ++axis) bounds.halfAxes[axis] = volume.toWorld.linear[axis] * half[axis];
    return bounds;
}

}  // namespace lumulus
