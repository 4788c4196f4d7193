#include "vdb/write.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <cassert>
#include <functional>
#include <span>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "vdb/grid_bytes.h"

namespace lumulus::vdb {
namespace {

/// The value of voxel (i, j, k) sits at index coordinate (i, j, k) in OpenVDB, half a voxel further in a Volume.
openvdb::math::Transform::Ptr indexToWorld(const Affine& toWorld) {
    const glm::dvec3 origin = toWorld.point(glm::dvec3(0.5));
    openvdb::Mat4d rows = openvdb::Mat4d::identity();  // OpenVDB multiplies row vectors from the left
    for (int axis = 0; axis < 3; ++axis) {
        for (int component = 0; component < 3; ++component) rows(axis, component) = toWorld.linear[axis][component];
        rows(3, axis) = origin[axis];
    }
    return openvdb::math::Transform::createLinearTransform(rows);
}

openvdb::FloatGrid::Ptr makeGrid(const Volume& volume) {
    const openvdb::CoordBBox box({0, 0, 0}, {volume.size.x - 1, volume.size.y - 1, volume.size.z - 1});
    // Dense has no view of constant memory; copyFromDense only reads
    const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, const_cast<float*>(volume.density.data()));
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0F);
    constexpr float tolerance = 0.0F;
    openvdb::tools::copyFromDense(dense, *grid, tolerance);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setCreator("Lumulus");
    grid->insertMeta("length_unit", openvdb::StringMetadata("metre"));
    grid->insertMeta("lumulus_name", openvdb::StringMetadata(volume.name));
    return grid;
}

openvdb::Vec3SGrid::Ptr makeGrid(const VelocityGrid& velocities) {
    openvdb::Vec3SGrid::Ptr grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0F));
    auto accessor = grid->getAccessor();
    std::size_t i = 0;
    for (int z = 0; z < velocities.size.z; ++z)
        for (int y = 0; y < velocities.size.y; ++y)
            for (int x = 0; x < velocities.size.x; ++x, ++i) {
                const glm::vec3& value = velocities.values[i];
                accessor.setValue({x, y, z}, {value.x, value.y, value.z});
            }
    grid->setName("vel");
    grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    grid->setTransform(indexToWorld(velocities.toWorld));
    return grid;
}

/// A file of one volume and what `more` makes beside it.
void writeGrids(const Volume& volume, const std::filesystem::path& path,
                const std::function<openvdb::GridBase::Ptr()>& more) {
    assert(volume.density.size() == volume.index(0, 0, volume.size.z));
    openvdb::initialize();
    std::string bytes;
    try {
        const openvdb::FloatGrid::Ptr grid = makeGrid(volume);
        grid->setTransform(indexToWorld(volume.toWorld));
        openvdb::GridCPtrVec grids{grid};
        if (more) grids.push_back(more());
        bytes = bytesOf(grids);
    } catch (const openvdb::ArithmeticError& error) {
        throw InputError(std::string("the cloud's transform cannot be saved: ") + error.what(), path.string(),
                         "give the cloud larger voxels");
    } catch (const openvdb::Exception& error) {
        throw Error(std::string("the cloud cannot be saved: ") + error.what(), path.string(), "report this");
    }
    writeFile(path, std::as_bytes(std::span(bytes)));
}

}  // namespace

void write(const Volume& volume, const std::filesystem::path& path) {
    writeGrids(volume, path, {});
}

void write(const Volume& volume, const VelocityGrid& velocities, const std::filesystem::path& path) {
    writeGrids(volume, path, [&velocities] { return makeGrid(velocities); });
}

}  // namespace lumulus::vdb
