#include "light/photon/ground.h"

#include <algorithm>
#include <cstring>

#include "gpu/groups.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/ground_counts.comp.h"
}  // namespace spirv

glm::vec3 share(const glm::dvec3& radiance, const glm::dvec3& of) {
    glm::vec3 result(0.0F);
    for (int channel = 0; channel < 3; ++channel)
        if (of[channel] > 0.0) result[channel] = static_cast<float>(radiance[channel] / of[channel]);
    return result;
}

}  // namespace

GroundWalk::GroundWalk(gpu::Context& context, std::uint32_t countBase)
    : context_(context),
      countBase_(countBase),
      program_(context, "ground_counts", spirv::ground_counts_comp),
      watts_(context, "ground light", groundCounts() * sizeof(float), gpu::Memory::host),
      commands_(context) {}

void GroundWalk::set(const Ground& ground, const glm::dmat3& cellsToWorld) {
    const glm::dvec3 brightest = ground.brightest();
    shared::GroundParams params{};
    params.cellsToWorld = glm::mat3(cellsToWorld);
    params.origin = glm::vec3(ground.corner - glm::dvec3(ground.lower.x, ground.height, ground.lower.y));
    params.extent = glm::vec2(ground.upper - ground.lower);
    params.cells = ground.cells;
    params.albedo = glm::vec3(ground.albedo);
    params.open = share(ground.open, brightest);
    params.sky = share(ground.sky, brightest);
    params.countBase = countBase_;
    const std::size_t bytes = sizeof(params) + ground.radiance.size() * sizeof(glm::vec3);
    if (!buffer_ || buffer_->bytes() != bytes) {
        buffer_.reset();
        buffer_.emplace(context_, "ground", bytes, gpu::Memory::host);
    }
    const auto mapped = buffer_->mapped<std::byte>();
    std::memcpy(mapped.data(), &params, sizeof(params));
    std::vector<glm::vec3> shares;
    shares.reserve(ground.radiance.size());
    for (const glm::vec3& radiance : ground.radiance) shares.push_back(share(glm::dvec3(radiance), brightest));
    std::memcpy(mapped.data() + sizeof(params), shares.data(), shares.size() * sizeof(glm::vec3));
}

std::vector<glm::vec3> GroundWalk::download(const Light& light) {
    commands_.begin();
    commands_.pass("ground counts");
    commands_.dispatch(program_, {{"Sum", *light.counts}, {"Watts", watts_}},
                       {countBase_, groundCounts(), static_cast<float>(light.unit)},
                       gpu::linearGroups(groundCounts(), 64));
    commands_.submit();
    commands_.wait();
    const auto watts = watts_.mapped<const float>();
    std::vector<glm::vec3> result(groundCounts() / 3);
    std::memcpy(result.data(), watts.data(), groundCounts() * sizeof(float));
    return result;
}

}  // namespace lumulus::photon
