#include "draw/billboard_shares.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw/drawing.h"
#include "gpu/commands.h"
#include "gpu/groups.h"
#include "shared/draw.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/billboard_mean.comp.h"
}  // namespace spirv

/// Of the share against what it is inside of the cloud: a sphere that hardly meets its own leaf must not glow.
constexpr double largest = 3.0;

/// Voxels of the leaf that hold density; no fewer than its mass fills at the greatest density, 1.
double filledVoxels(const cloud::Collector& collector) {
    return std::max(collector.occupiedVoxels(), static_cast<double>(collector.mass));
}

}  // namespace

double billboardRadius(const cloud::Asset& cloud, const cloud::Collector& collector) {
    const double volume = static_cast<double>(shared::BILLBOARD_OVERLAP) * filledVoxels(collector) * cloud.voxelVolume;
    return std::cbrt(volume * 3.0 / (4.0 * std::numbers::pi));
}

std::vector<float> billboardShares(gpu::Context& context, const cloud::Asset& cloud) {
    const std::size_t count = cloud.collectors.size();
    std::vector<glm::vec4> spheres;
    spheres.reserve(count);
    for (const cloud::Collector& collector : cloud.collectors)
        spheres.emplace_back(collector.centre, billboardRadius(cloud, collector));
    const gpu::Program<shared::BillboardMeanPush> program(context, "billboard_mean", spirv::billboard_mean_comp,
                                                          {cloud.sparseConstant()});
    const gpu::Buffer input = gpu::filledBuffer(context, "billboard spheres", spheres);
    const gpu::Buffer means(context, "billboard means", count * sizeof(float), gpu::Memory::host);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("billboard means");
    commands.dispatch(program,
                      {{"density", *cloud.density, gpu::Sampler::linear},
                       {"bricks", cloud.brickIndex(), gpu::Sampler::nearest},
                       {"Spheres", input},
                       {"Means", means}},
                      shared::BillboardMeanPush{glm::mat3(glm::inverse(cloud.voxelToMetres)),
                                                1.0F / glm::vec3(cloud.size), static_cast<std::uint32_t>(count)},
                      gpu::linearGroups(static_cast<std::uint32_t>(count), 64));
    commands.submit();
    commands.wait();
    std::vector<float> shares;
    shares.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double filled = filledVoxels(cloud.collectors[i]), mass = static_cast<double>(cloud.collectors[i].mass);
        const double mean = static_cast<double>(means.mapped<const float>()[i]);
        const double share = mass < largest * mean * filled ? mass / (mean * filled) : largest;
        shares.push_back(static_cast<float>(share) / shared::BILLBOARD_OVERLAP);
    }
    return shares;
}

}  // namespace lumulus::draw
