#include "light/photon/photon_starts.h"

#include <algorithm>

#include "gpu/groups.h"
#include "light/photon/surroundings.h"
#include "shared/world.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/start_world.comp.h"
}  // namespace spirv

/// Of all invocations in a round: 24 MiB.
constexpr std::uint64_t mostStarts = 1U << 19U;
/// A photon takes more than this many steps on average; a round of few steps is not the last one.
constexpr std::uint32_t stepsOfEach = 8, moreStarts = 8;

/// Of each invocation.
std::uint32_t startsFor(const Options& options, std::uint32_t invocations) {
    const std::uint64_t all = (options.photonsPerGeneration + invocations - 1) / invocations;
    return static_cast<std::uint32_t>(std::min(all, std::max<std::uint64_t>(1, mostStarts / invocations)));
}

}  // namespace

PhotonStarts::PhotonStarts(gpu::Context& context, const WorldWalk& walk, const Options& options,
                           std::uint32_t invocations)
    : walk_(walk),
      invocations_(invocations),
      most_(startsFor(options, invocations)),
      program_(context, "start_world", spirv::start_world_comp,
               withSurroundings({gpu::SpecConstant::of(5, options.air)}, options, true)),
      starts_(context, "photon starts", std::uint64_t{shared::START_TEXELS} * most_ * invocations,
              VK_FORMAT_R32G32B32A32_SFLOAT, gpu::Memory::device) {}

void PhotonStarts::record(gpu::Commands& commands, const std::vector<gpu::Binding>& bindings,
                          std::uint32_t steps) const {
    const std::uint32_t each = std::min(most_, steps / stepsOfEach + moreStarts);
    walk_.setStarts(each);
    std::vector<gpu::Binding> wanted = walk_.entryBindings();
    wanted.push_back(binding());
    for (const gpu::Binding& one : bindings)
        for (const char* name : {"Params", "States", "SkyCells", "SunColours", "FogSky", "GroundLight", "MeshShade"})
            if (one.name == name) wanted.push_back(one);
    commands.pass("photon starts");
    commands.dispatch(program_, wanted, {}, gpu::linearGroups(std::uint64_t{each} * invocations_, 64));
    commands.barrier("photon starts");
}

}  // namespace lumulus::photon
