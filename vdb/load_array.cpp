#include "vdb/load_array.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

#include "base/error.h"
#include "vdb/convert.h"

namespace lumulus::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

void check(const DensityArray& array) {
    constexpr double leastEdge = 1e-6, mostMetres = 1e9;
    const glm::i64vec3 size(array.size);
    if (glm::any(glm::lessThan(size, glm::i64vec3(1))) ||
        size.x * size.y * size.z != static_cast<std::int64_t>(array.values.size()))
        throw InputError("the array has no value in it", array.name, "give one of at least one voxel along x, y and z");
    for (int axis = 0; axis < 3; ++axis) {
        if (!(array.edges[axis] >= leastEdge && array.edges[axis] <= mostMetres))
            throw InputError(fmt::format("a voxel has the edge {} m", array.edges[axis]), array.name,
                             "give one of 1e-6 to 1e9 m");
        if (!(std::abs(array.origin[axis]) <= mostMetres))
            throw InputError(fmt::format("the origin has the coordinate {} m", array.origin[axis]), array.name,
                             "give a place within 1e9 m");
    }
}

/// Copies the values of a leaf; those that are 0 stay inactive, those that are not a number are active.
void fill(Leaf& leaf, const DensityArray& array) {
    const openvdb::Coord first = leaf.origin();
    const glm::ivec3 end = glm::min(glm::ivec3(Leaf::DIM), array.size - glm::ivec3(first.x(), first.y(), first.z()));
    for (int x = 0; x < end.x; ++x)
        for (int y = 0; y < end.y; ++y) {
            const auto row = (static_cast<std::size_t>(first.x() + x) * static_cast<std::size_t>(array.size.y) +
                              static_cast<std::size_t>(first.y() + y)) *
                                 static_cast<std::size_t>(array.size.z) +
                             static_cast<std::size_t>(first.z());
            for (int z = 0; z < end.z; ++z) {
                const float value = array.values[row + static_cast<std::size_t>(z)];
                if (value != 0.0F) leaf.setValueOn(openvdb::Coord(x, y, z), value);
            }
        }
}

openvdb::FloatGrid::Ptr gridOf(const DensityArray& array, const Check& stop) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0F);
    grid->setName(array.name);
    openvdb::math::Mat4d rows = openvdb::math::Mat4d::identity();  // OpenVDB multiplies row vectors from the left
    for (int axis = 0; axis < 3; ++axis) {
        rows(axis, axis) = array.edges[axis];
        rows(3, axis) = array.origin[axis];
    }
    grid->setTransform(openvdb::math::Transform::createLinearTransform(rows));
    openvdb::FloatTree& tree = grid->tree();
    constexpr int edge = Leaf::DIM;
    for (int x = 0; x < array.size.x; x += edge) {
        stop();
        for (int y = 0; y < array.size.y; y += edge)
            for (int z = 0; z < array.size.z; z += edge) {
                auto leaf = std::make_unique<Leaf>(openvdb::Coord(x, y, z), 0.0F);
                fill(*leaf, array);
                if (!leaf->isEmpty()) tree.addLeaf(leaf.release());
            }
    }
    return grid;
}

}  // namespace

LoadResult loadArray(const DensityArray& array, const LoadOptions& options) {
    check(array);
    openvdb::initialize();
    try {
        return convert(gridOf(array, options.limits.check), options, array.name);
    } catch (const std::bad_alloc&) {
        throw Error("the array does not fit the memory of this machine", array.name, "give a smaller one");
    }
}

}  // namespace lumulus::vdb
