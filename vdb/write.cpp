#include "vdb/write.h"

#include <fmt/format.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <cassert>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"

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

/// FNV-1a (Fowler, Noll, Vo), 64 bits.
std::uint64_t hashOf(std::string_view bytes, std::uint64_t hash) {
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
    return hash;
}

/// Replaces the random UUID that OpenVDB gives each file by one from the content (RFC 9562, version 8), so that equal
/// clouds give equal bytes.
void setContentUuid(std::string& file) {
    constexpr std::size_t start = 21;   // after the magic number, three versions and a flag
    constexpr std::size_t length = 36;  // in text
    const std::string_view content = std::string_view(file).substr(start + length);
    std::uint64_t high = hashOf(content, 0xCBF29CE484222325U);
    std::uint64_t low = hashOf(content, high);
    high = (high & 0xFFFFFFFFFFFF0FFFU) | 0x8000U;
    low = (low >> 2U) | 0x8000000000000000U;
    file.replace(start, length,
                 fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32U, (high >> 16U) & 0xFFFFU,
                             high & 0xFFFFU, low >> 48U, low & 0xFFFFFFFFFFFFU));
}

}  // namespace

void write(const Volume& volume, const std::filesystem::path& path) {
    assert(volume.density.size() == volume.index(0, 0, volume.size.z));
    openvdb::initialize();
    std::string bytes;
    try {
        const openvdb::FloatGrid::Ptr grid = makeGrid(volume);
        grid->setTransform(indexToWorld(volume.toWorld));
        std::ostringstream out(std::ios::binary);
        out.exceptions(std::ios::badbit | std::ios::failbit);
        openvdb::io::Stream(out).write(openvdb::GridCPtrVec{grid});
        bytes = std::move(out).str();
    } catch (const openvdb::ArithmeticError& error) {
        throw InputError(std::string("the cloud's transform cannot be saved: ") + error.what(), path.string(),
                         "give the cloud larger voxels");
    } catch (const openvdb::Exception& error) {
        throw Error(std::string("the cloud cannot be saved: ") + error.what(), path.string(), "report this");
    }
    setContentUuid(bytes);
    writeFile(path, std::as_bytes(std::span(bytes)));
}

}  // namespace lumulus::vdb
