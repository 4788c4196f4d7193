#include "draw/sun_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/sun_depth.comp.h"
}  // namespace spirv

/// 64 MiB of half floats.
constexpr double maxTexels = 32.0 * 1024 * 1024;

/// Columns: two unit vectors across the light and the light itself.
glm::dmat3 lightFrame(const glm::dvec3& travel) {
    const glm::dvec3 helper = std::abs(travel.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(helper, travel));
    return {across, glm::cross(travel, across), travel};
}

}  // namespace

SunGrid makeSunGrid(const cloud::Cloud& cloud, const glm::dvec3& sunTravel, double maxTexels) {
    const glm::dmat3 frame = lightFrame(sunTravel);
    const glm::dmat3 voxelToLight = glm::transpose(frame) * cloud.toWorld.linear;
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p =
            voxelToLight * (glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2) * glm::dvec3(cloud.size));
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    const glm::dvec3 extent = upper - lower;
    SunGrid grid;
    const double finest = std::cbrt(cloud.voxelVolume);
    const double coarsest = std::cbrt(extent.x * extent.y * extent.z / maxTexels);
    const double widest = std::max(extent.x, std::max(extent.y, extent.z)) / 2000.0;  // 3D images end at 2048 texels
    grid.spacing = std::max(finest, std::max(coarsest, widest));
    grid.size = glm::ivec3(glm::ceil(extent / grid.spacing)) + 1;
    const glm::dmat3 lightToVoxel = glm::inverse(voxelToLight);
    grid.gridToVoxel = lightToVoxel * grid.spacing;
    grid.originVoxel = lightToVoxel * lower;
    return grid;
}

SunDepth::SunDepth(gpu::Context& context, const cloud::Cloud& cloud)
    : context_(context), cloud_(cloud), program_(context, "sun_depth", spirv::sun_depth_comp) {}

void SunDepth::record(gpu::Commands& commands, const glm::dvec3& sunTravel, double extinction) {
    const SunGrid grid = makeSunGrid(cloud_, sunTravel, maxTexels);
    if (!image_ || image_->extent() != grid.size)
        image_.emplace(context_, "sun depth", grid.size, VK_FORMAT_R16_SFLOAT);
    const glm::vec3 inverseSize = 1.0F / glm::vec3(cloud_.size);
    commands.pass("sun depth");
    commands.dispatch(
        program_, {{"density", cloud_.density, gpu::Sampler::linear}, {"sunDepth", *image_}},
        shared::SunDepthPush{glm::mat3(grid.gridToVoxel), glm::vec3(grid.originVoxel), inverseSize, grid.size,
                             static_cast<float>(extinction * grid.spacing)},
        {(static_cast<std::uint32_t>(grid.size.x) + 7) / 8, (static_cast<std::uint32_t>(grid.size.y) + 7) / 8, 1});
    const glm::dmat3 toTexel = glm::inverse(grid.gridToVoxel);
    const glm::dmat3 scale(glm::dvec3(1.0 / grid.size.x, 0, 0), glm::dvec3(0, 1.0 / grid.size.y, 0),
                           glm::dvec3(0, 0, 1.0 / grid.size.z));
    voxelToTexture_ = glm::mat3(scale * toTexel);
    textureOffset_ = glm::vec3(scale * (glm::dvec3(0.5) - toTexel * grid.originVoxel));
}

}  // namespace lumulus::draw
