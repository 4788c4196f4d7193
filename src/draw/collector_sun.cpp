#include "draw/collector_sun.h"

#include <vector>

#include "draw/frame.h"
#include "gpu/groups.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/collector_sun.comp.h"
}  // namespace spirv

std::vector<shared::LeafBox> boxesOf(const cloud::Cloud& cloud) {
    std::vector<shared::LeafBox> boxes;
    boxes.reserve(cloud.collectors.size());
    for (const cloud::Collector& collector : cloud.collectors) boxes.push_back(collector.box);
    return boxes;
}

}  // namespace

CollectorSun::CollectorSun(gpu::Context& context, const cloud::Cloud& cloud)
    : cloud_(cloud),
      program_(context, "collector_sun", spirv::collector_sun_comp),
      boxes_(filledBuffer(context, "collector boxes", boxesOf(cloud))),
      values_(context, "collector sun depths", cloud.collectors.size() * sizeof(float), gpu::Memory::host) {}

void CollectorSun::record(gpu::Commands& commands, const SunDepth& depths) const {
    const auto collectors = static_cast<std::uint32_t>(cloud_.collectors.size());
    commands.pass("collector sun");
    commands.dispatch(program_,
                      {{"density", cloud_.density, gpu::Sampler::linear},
                       {"sunDepth", depths.image(), gpu::Sampler::linearClamp},
                       {"Boxes", boxes_},
                       {"SunDepths", values_}},
                      shared::CollectorSunPush{depths.voxelToTexture(), depths.textureOffset(),
                                               1.0F / glm::vec3(cloud_.size), collectors},
                      gpu::linearGroups(collectors, 64));
}

std::span<const float> CollectorSun::values() const {
    return values_.mapped<const float>().subspan(0, cloud_.collectors.size());
}

}  // namespace lumulus::draw
