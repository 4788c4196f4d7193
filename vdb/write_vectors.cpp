#include "vdb/write_vectors.h"

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include <exception>
#include <sstream>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "vdb/grid_bytes.h"

namespace lumulus::vdb {
namespace {

openvdb::Vec3SGrid::Ptr gridOf(const VectorGrids& all, const VectorGrid& one) {
    openvdb::Vec3SGrid::Ptr grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0F));
    auto accessor = grid->getAccessor();
    for (std::size_t i = 0; i < all.places.size(); ++i) {
        const glm::ivec3& at = all.places[i];
        const glm::vec3& value = one.values[i];
        accessor.setValueOn(openvdb::Coord(at.x, at.y, at.z), openvdb::Vec3s(value.x, value.y, value.z));
    }
    grid->setName(one.name);
    grid->setCreator("Lumulus");
    grid->setVectorType(one.isDirection ? openvdb::VEC_CONTRAVARIANT_RELATIVE : openvdb::VEC_INVARIANT);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(all.voxel));
    grid->insertMeta("length_unit", openvdb::StringMetadata("metre"));
    grid->insertMeta("unit", openvdb::StringMetadata(one.unit));
    grid->insertMeta("meaning", openvdb::StringMetadata(one.meaning));
    return grid;
}

std::string nanoBytes(const std::vector<openvdb::Vec3SGrid::Ptr>& grids, const Check& check) {
    std::vector<nanovdb::GridHandle<>> handles;
    for (const openvdb::Vec3SGrid::Ptr& grid : grids) {
        check();
        handles.push_back(nanovdb::openToNanoVDB(*grid));
    }
    nanovdb::io::Segment header(nanovdb::io::Codec::NONE);
    for (const nanovdb::GridHandle<>& handle : handles) header.add(handle);
    // the library leaves room for the header and comes back to it: a stream in memory must have that room
    std::ostringstream out(std::string(header.memUsage(), '\0'), std::ios::binary);
    nanovdb::io::writeGrids<nanovdb::HostBuffer, std::vector>(out, handles, nanovdb::io::Codec::NONE);
    return std::move(out).str();
}

}  // namespace

void writeVectors(const std::filesystem::path& path, const VectorGrids& grids, VectorFormat format,
                  const Check& check) {
    openvdb::initialize();
    std::vector<openvdb::Vec3SGrid::Ptr> made;
    for (const VectorGrid& grid : grids.grids) {
        check();
        made.push_back(gridOf(grids, grid));
    }
    std::string bytes;
    try {
        bytes = format == VectorFormat::nanoVdb ? nanoBytes(made, check)
                                                : bytesOf(openvdb::GridCPtrVec(made.begin(), made.end()));
    } catch (const openvdb::Exception& error) {
        throw Error(std::string("the grids cannot be saved: ") + error.what(), path.string(), "report this");
    }
    check();
    writeFile(path, std::as_bytes(std::span(bytes)));
}

}  // namespace lumulus::vdb
