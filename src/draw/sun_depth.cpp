#include "draw/sun_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "shared/cloud.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/collector_sun.comp.h"
#include "spirv/draw/sun_depth.comp.h"
}  // namespace spirv

/// 64 MiB of half floats.
constexpr double maxTexels = 32.0 * 1024 * 1024;

std::vector<shared::LeafBox> boxesOf(const cloud::Cloud& cloud) {
    std::vector<shared::LeafBox> boxes;
    for (const cloud::Collector& collector : cloud.collectors) boxes.push_back(collector.box);
    return boxes;
}

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
    : context_(context),
      cloud_(cloud),
      gridProgram_(context, "sun_depth", spirv::sun_depth_comp),
      collectorProgram_(context, "collector_sun", spirv::collector_sun_comp),
      boxes_(context, "collector boxes", cloud.collectors.size() * sizeof(shared::LeafBox), gpu::Memory::device),
      depths_(context, "collector sun depths", cloud.collectors.size() * sizeof(float), gpu::Memory::device) {
    gpu::upload(context, boxes_, boxesOf(cloud));
}

void SunDepth::record(gpu::Commands& commands, const glm::dvec3& sunTravel, double extinction) {
    const SunGrid grid = makeSunGrid(cloud_, sunTravel, maxTexels);
    if (!image_ || image_->extent() != grid.size)
        image_.emplace(context_, "sun depth", grid.size, VK_FORMAT_R16_SFLOAT);
    const glm::vec3 inverseSize = 1.0F / glm::vec3(cloud_.size);
    commands.pass("sun depth");
    commands.dispatch(
        gridProgram_, {{"density", cloud_.density, gpu::Sampler::linear}, {"sunDepth", *image_}},
        shared::SunDepthPush{glm::mat3(grid.gridToVoxel), glm::vec3(grid.originVoxel), inverseSize, grid.size,
                             static_cast<float>(extinction * grid.spacing)},
        {(static_cast<std::uint32_t>(grid.size.x) + 7) / 8, (static_cast<std::uint32_t>(grid.size.y) + 7) / 8, 1});
    commands.barrier("sun depth");
    const glm::dmat3 toTexel = glm::inverse(grid.gridToVoxel);
    const glm::dmat3 scale(glm::dvec3(1.0 / grid.size.x, 0, 0), glm::dvec3(0, 1.0 / grid.size.y, 0),
                           glm::dvec3(0, 0, 1.0 / grid.size.z));
    voxelToTexture_ = glm::mat3(scale * toTexel);
    textureOffset_ = glm::vec3(scale * (glm::dvec3(0.5) - toTexel * grid.originVoxel));
    const auto collectors = static_cast<std::uint32_t>(cloud_.collectors.size());
    commands.dispatch(collectorProgram_,
                      {{"density", cloud_.density, gpu::Sampler::linear},
                       {"sunDepth", *image_, gpu::Sampler::linearClamp},
                       {"Boxes", boxes_},
                       {"SunDepths", depths_}},
                      shared::CollectorSunPush{voxelToTexture_, textureOffset_, inverseSize, collectors},
                      gpu::linearGroups(collectors, 64));
}

}  // namespace lumulus::draw
