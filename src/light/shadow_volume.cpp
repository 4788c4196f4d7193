#include "light/shadow_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloud/voxel_shape.h"

namespace lumulus::light {

namespace {

namespace spirv {
#include "spirv/light/shadow_volume.comp.h"
}  // namespace spirv

/// 64 MiB of half floats.
constexpr double maxTexels = 32.0 * 1024 * 1024;
/// 3D images end at 2048 texels.
constexpr double mostAcross = 2000.0;
constexpr int groupEdge = 8;  // of shadow_volume.comp

/// Columns: two unit vectors across the light and the light itself.
glm::dmat3 lightFrame(const glm::dvec3& travel) {
    const glm::dvec3 helper = std::abs(travel.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(helper, travel));
    return {across, glm::cross(travel, across), travel};
}

glm::dmat3 texelToTexture(const ShadowGrid& grid) {
    return {1.0 / grid.size.x, 0, 0, 0, 1.0 / grid.size.y, 0, 0, 0, 1.0 / grid.size.z};
}

/// With its columns so many times as long.
glm::dmat3 scaled(const glm::dmat3& matrix, const glm::dvec3& factors) {
    return {matrix[0] * factors.x, matrix[1] * factors.y, matrix[2] * factors.z};
}

/// Columns of a sheared grid: two voxel axes, and the light from one layer of voxels to the next along the third, the
/// one along which it crosses the most. Texels are as fine as the voxels, whatever their shape.
ShadowGrid layeredGrid(const glm::dvec3& size, const glm::dmat3& voxelToMetres, const glm::dvec3& sunTravel,
                       double most, int reduction, const glm::dvec3& wider) {
    const glm::dvec3 travel = glm::inverse(voxelToMetres) * sunTravel;
    int along = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(travel[axis]) > std::abs(travel[along])) along = axis;
    const int axes[2] = {(along + 1) % 3, (along + 2) % 3};
    const glm::dvec3 layer = travel / std::abs(travel[along]);
    glm::dvec3 extent(0.0, 0.0, size[along]), origin(0.0);
    origin[along] = travel[along] > 0.0 ? 0.0 : size[along];
    glm::dmat3 columns(0.0);
    for (int i = 0; i < 2; ++i) {
        // by so much the light drifts aside on its way through all layers
        const double drift = layer[axes[i]] * size[along];
        origin[axes[i]] = std::min(0.0, -drift);
        extent[i] = size[axes[i]] + std::abs(drift);
        columns[i][axes[i]] = 1.0;
    }
    columns[2] = layer;
    const double coarsest = std::cbrt(extent.x * extent.y * extent.z / most);
    const double widest = std::max(extent.x, std::max(extent.y, extent.z)) / mostAcross;
    const double texel = reduction * std::max(1.0, std::max(coarsest, widest));
    ShadowGrid grid;
    grid.size = glm::ivec3(glm::ceil(extent / (texel * wider))) + 1;
    grid.gridToVoxel = scaled(columns, texel * wider);
    grid.originVoxel = origin;
    grid.spacing = texel * glm::length(voxelToMetres * layer);
    return grid;
}

}  // namespace

ShadowGrid makeShadowGrid(const glm::ivec3& voxels, const glm::dmat3& voxelToMetres, const glm::dvec3& sunTravel,
                          double maxTexels, int reduction, int across) {
    const glm::dvec3 size(voxels), wider(across, across, 1.0);
    // a cubic texel would hold many flat voxels along their short edge
    if (cloud::hasFlatVoxels(voxelToMetres))
        return layeredGrid(size, voxelToMetres, sunTravel, maxTexels, reduction, wider);
    const glm::dmat3 frame = lightFrame(sunTravel);
    const glm::dmat3 voxelToLight = glm::transpose(frame) * voxelToMetres;
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p = voxelToLight * (glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2) * size);
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    const glm::dvec3 extent = upper - lower;
    ShadowGrid grid;
    const double finest = std::cbrt(std::abs(glm::determinant(voxelToMetres)));
    const double coarsest = std::cbrt(extent.x * extent.y * extent.z / maxTexels);
    const double widest = std::max(extent.x, std::max(extent.y, extent.z)) / mostAcross;
    grid.spacing = reduction * std::max(finest, std::max(coarsest, widest));
    grid.size = glm::ivec3(glm::ceil(extent / (grid.spacing * wider))) + 1;
    const glm::dmat3 lightToVoxel = glm::inverse(voxelToLight);
    grid.gridToVoxel = scaled(lightToVoxel, grid.spacing * wider);
    grid.originVoxel = lightToVoxel * lower;
    return grid;
}

ShadowVolume::ShadowVolume(gpu::Context& context, const cloud::Asset& cloud, const glm::dmat3& voxelToMetres,
                           int across)
    : context_(context),
      cloud_(cloud),
      voxelToMetres_(voxelToMetres),
      across_(across),
      program_(context, "shadow_volume", spirv::shadow_volume_comp, {cloud.sparseConstant()}) {}

void ShadowVolume::lay(Filled& filled, const glm::dvec3& sunTravel, double extinction, int reduction) {
    filled.grid = makeShadowGrid(cloud_.size, voxelToMetres_, sunTravel, maxTexels, reduction, across_);
    filled.step = static_cast<float>(extinction * filled.grid.spacing);
    filled.rows = 0;
    if (!filled.image || filled.image->extent() != filled.grid.size)
        filled.image.emplace(context_, "shadow volume", filled.grid.size, VK_FORMAT_R16_SFLOAT);
}

void ShadowVolume::fill(gpu::Commands& commands, Filled& filled, int rows) {
    const ShadowGrid& grid = filled.grid;
    const auto groups = [](int count) { return static_cast<std::uint32_t>((count + groupEdge - 1) / groupEdge); };
    commands.pass("shadow volume");
    commands.dispatch(program_,
                      {{"density", *cloud_.density, gpu::Sampler::linear},
                       {"bricks", cloud_.brickIndex(), gpu::Sampler::nearest},
                       {"shadowVolume", *filled.image}},
                      shared::ShadowVolumePush{glm::mat3(grid.gridToVoxel), glm::vec3(grid.originVoxel),
                                               1.0F / glm::vec3(cloud_.size), grid.size, filled.step, filled.rows},
                      {groups(grid.size.x), groups(rows), 1});
    filled.rows += rows;
}

void ShadowVolume::record(gpu::Commands& commands, const glm::dvec3& sunTravel, double extinction, int reduction) {
    next_.image.reset();
    lay(shown_, sunTravel, extinction, reduction);
    fill(commands, shown_, shown_.grid.size.y);
}

void ShadowVolume::begin(const glm::dvec3& sunTravel, double extinction) {
    lay(next_, sunTravel, extinction, 1);
}

bool ShadowVolume::recordPart(gpu::Commands& commands, double share) {
    const int all = next_.grid.size.y;
    const int wanted = static_cast<int>(share * all / groupEdge + 1.0) * groupEdge;
    fill(commands, next_, std::min(wanted, all - next_.rows));
    if (next_.rows < all) return false;
    std::swap(shown_, next_);
    return true;
}

glm::mat3 ShadowVolume::voxelToTexture() const {
    return glm::mat3(texelToTexture(shown_.grid) * glm::inverse(shown_.grid.gridToVoxel));
}

glm::vec3 ShadowVolume::textureOffset() const {
    const ShadowGrid& grid = shown_.grid;
    return glm::vec3(texelToTexture(grid) * (glm::dvec3(0.5) - glm::inverse(grid.gridToVoxel) * grid.originVoxel));
}

}  // namespace lumulus::light
