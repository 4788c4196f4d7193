#include "vdb/velocity.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

#include "base/error.h"
#include "vdb/file.h"

namespace lumulus::vdb {

namespace {

constexpr std::array<std::string_view, 3> names{"vel", "velocity", "v"};

std::string lower(std::string name) {
    std::ranges::transform(name, name.begin(),
                           [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    return name;
}

/// The grid of the file that comes first among the names.
std::optional<std::size_t> findGrid(const openvdb::GridPtrVec& grids) {
    for (const std::string_view name : names)
        for (std::size_t i = 0; i < grids.size(); ++i)
            if (lower(grids[i]->getName()) == name && grids[i]->isType<openvdb::Vec3SGrid>()) return i;
    return std::nullopt;
}

void requireNumbers(const openvdb::Vec3SGrid& grid, const std::string& where, const Check& check) {
    const auto require = [&](auto value) {
        for (; value; ++value)
            if (!value->isFinite())
                throw InputError(fmt::format("grid \"{}\" has a velocity that is no number", grid.getName()), where,
                                 "write the file again, or leave that grid out");
    };
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        check();
        require(leaf->cbeginValueOn());
    }
    auto tiles = grid.tree().cbeginValueOn();
    tiles.setMaxDepth(tiles.getLeafDepth() - 1);
    require(tiles);
}

/// Refuses a grid of another place or another unit of length than the cloud's.
void requireOverlap(const openvdb::Vec3SGrid& grid, const VoxelBox& density, const std::string& where) {
    const openvdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
    if (active.empty() || density.size == glm::ivec3(0)) return;
    openvdb::BBoxd cloud;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner =
            density.toWorld.point(glm::dvec3(density.size) * glm::dvec3(i & 1, (i >> 1) & 1, i >> 2));
        cloud.expand(grid.transform().worldToIndex(openvdb::Vec3d(corner.x, corner.y, corner.z)));
    }
    const openvdb::BBoxd moving(active.min().asVec3d(), active.max().asVec3d());
    if (!moving.hasOverlap(cloud))
        throw InputError(
            fmt::format("grid \"{}\" lies outside of the cloud: its transform is another one", grid.getName()), where,
            "write velocities where the density is, or leave that grid out");
}

}  // namespace

struct VelocityField::Grid {
    using Reader = openvdb::Vec3SGrid::ConstUnsafeAccessor;

    explicit Grid(openvdb::Vec3SGrid::ConstPtr grid)
        : values(std::move(grid)),
          staggered(values->getGridClass() == openvdb::GRID_STAGGERED),
          readers([this] { return Reader(values->tree()); }) {}

    openvdb::Vec3SGrid::ConstPtr values;
    bool staggered;
    mutable tbb::enumerable_thread_specific<Reader> readers;  ///< each remembers where its thread has looked last
};

std::optional<VelocityField> VelocityField::read(const std::filesystem::path& path, const VoxelBox& density,
                                                 const ReadLimits& limits) {
    GridFile file(path, limits);
    const std::optional<std::size_t> index = findGrid(file.grids());
    if (!index) return std::nullopt;
    auto grid = std::make_unique<Grid>(openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(file.read(*index)));
    const openvdb::math::Transform& transform = grid->values->transform();
    const double volume = transform.isLinear() ? transform.voxelSize().product() : 0.0;
    if (!(std::isfinite(volume) && volume > 0.0))
        throw InputError(
            fmt::format("grid \"{}\" has a transform that is not affine or is singular", grid->values->getName()),
            path.string(), "write the file again, or leave that grid out");
    requireNumbers(*grid->values, path.string(), limits.check);
    requireOverlap(*grid->values, density, path.string());
    return VelocityField(std::move(grid));
}

VelocityField::VelocityField(std::unique_ptr<const Grid> grid) : grid_(std::move(grid)) {}
VelocityField::VelocityField(VelocityField&&) noexcept = default;
VelocityField& VelocityField::operator=(VelocityField&&) noexcept = default;
VelocityField::~VelocityField() = default;

glm::dvec3 VelocityField::at(const glm::dvec3& place) const {
    const openvdb::Vec3SGrid& grid = *grid_->values;
    const openvdb::Vec3d index = grid.transform().worldToIndex(openvdb::Vec3d(place.x, place.y, place.z));
    const Grid::Reader& reader = grid_->readers.local();
    const openvdb::Vec3s value = grid_->staggered ? openvdb::tools::StaggeredBoxSampler::sample(reader, index)
                                                  : openvdb::tools::BoxSampler::sample(reader, index);
    return {value.x(), value.y(), value.z()};
}

}  // namespace lumulus::vdb
