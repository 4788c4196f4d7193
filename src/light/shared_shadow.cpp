#include "light/shared_shadow.h"

#include <cmath>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::light {

namespace {

namespace spirv {
#include "spirv/light/shared_shadow.comp.h"
}  // namespace spirv

/// A sphere round the box of an instance.
struct Ball {
    glm::dvec3 middle;
    double radius;
};

/// Whether something of `occluder` may lie between a point of `shaded` and the sun.
bool mayShade(const Ball& occluder, const Ball& shaded, const glm::dvec3& sunTravel) {
    const glm::dvec3 apart = shaded.middle - occluder.middle;
    const double along = glm::dot(apart, sunTravel), reach = occluder.radius + shaded.radius;
    return along > -reach && glm::length(apart - along * sunTravel) < reach;
}

/// From texel numbers of the shaded instance's volume to texel coordinates of the occluder's.
shared::Occluder placeOf(const Shading& occluder, const Shading& shaded) {
    const ShadowGrid& from = shaded.shadow->grid();
    const ShadowGrid& to = occluder.shadow->grid();
    const cloud::Instance &a = *shaded.instance, &b = *occluder.instance;
    const glm::dmat3 voxelToVoxel = glm::inverse(b.voxelToMetres) * a.voxelToMetres;
    const glm::dvec3 apart = glm::inverse(b.voxelToMetres) * ((a.origin + a.offset) - (b.origin + b.offset));
    const glm::dmat3 voxelToTexel = glm::inverse(to.gridToVoxel);
    shared::Occluder place{};
    place.texelToTexel = glm::mat3(voxelToTexel * voxelToVoxel * from.gridToVoxel);
    place.offset = glm::vec3(voxelToTexel * (voxelToVoxel * from.originVoxel + apart - to.originVoxel) + 0.5);
    return place;
}

}  // namespace

Occluders findOccluders(std::span<const Shading> all, const glm::dvec3& sunTravel) {
    std::vector<Ball> balls;
    for (const Shading& one : all) balls.push_back({one.instance->middle(), 0.5 * one.instance->diagonal()});
    Occluders found;
    for (std::size_t i = 0; i < all.size(); ++i) {
        found.first.push_back(static_cast<std::uint32_t>(found.numbers.size()));
        if (all[i].shadow == nullptr) continue;
        for (std::size_t j = 0; j < all.size(); ++j) {
            if (all[j].shadow == nullptr || !mayShade(balls[j], balls[i], sunTravel)) continue;
            found.numbers.push_back(static_cast<std::uint32_t>(j));
            found.places.push_back(placeOf(all[j], all[i]));
        }
    }
    found.first.push_back(static_cast<std::uint32_t>(found.numbers.size()));
    return found;
}

SharedShadow::SharedShadow(gpu::Context& context)
    : context_(context),
      program_(context, "shared_shadow", spirv::shared_shadow_comp),
      none_(context, "no shadow volume", glm::ivec3(1), VK_FORMAT_R16_SFLOAT) {}

/// Instances that all move together stay as they are to each other.
std::vector<glm::dvec4> SharedShadow::keyOf(std::span<const Shading> all) {
    std::vector<glm::dvec4> key;
    for (const Shading& one : all)
        key.emplace_back(one.instance->offset - all.front().instance->offset, static_cast<double>(one.version));
    return key;
}

void SharedShadow::fit(std::span<const gpu::Image* const> images) {
    if (own_ && own_->holds(images)) return;
    own_.reset();
    together_.reset();
    own_.emplace(context_, "own shadow volumes", images, VK_FORMAT_R16_SFLOAT);
    together_.emplace(context_, "shared shadow volumes", images, VK_FORMAT_R16_SFLOAT);
}

void SharedShadow::record(gpu::Commands& commands, std::span<const Shading> all, const glm::dvec3& sunTravel) {
    std::vector<const gpu::Image*> images;
    for (const Shading& one : all) images.push_back(one.shadow != nullptr ? &one.shadow->image() : &none_);
    fit(images);
    madeFor_ = keyOf(all);
    Occluders found = findOccluders(all, sunTravel);
    for (std::size_t i = 0; i < found.places.size(); ++i) {
        found.places[i].origin = glm::vec3(own_->origin(found.numbers[i]));
        found.places[i].size = glm::vec3(images[found.numbers[i]]->extent());
    }
    if (found.places.empty()) return;
    occluders_.reset();
    occluders_.emplace(gpu::filledBuffer(context_, "occluders", found.places));
    own_->record(commands, images);
    commands.pass("shared shadow");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::uint32_t first = found.first[i], count = found.first[i + 1] - first;
        if (count == 0) continue;
        const glm::ivec3 size = images[i]->extent();
        const auto texels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
                            static_cast<std::uint64_t>(size.z);
        commands.dispatch(program_,
                          {{"own", own_->image(), gpu::Sampler::linearClamp},
                           {"together", together_->image()},
                           {"Occluders", *occluders_}},
                          {size, together_->origin(i), first, count}, gpu::linearGroups(texels, 64));
        commands.barrier("shared shadow volume");
    }
}

}  // namespace lumulus::light
