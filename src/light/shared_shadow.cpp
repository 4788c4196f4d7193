#include "light/shared_shadow.h"

#include <algorithm>
#include <cmath>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::light {

namespace {

namespace spirv {
#include "spirv/light/shared_shadow.comp.h"
}  // namespace spirv

/// Columns: two unit vectors across the light and the light itself.
glm::dmat3 lightFrame(const glm::dvec3& travel) {
    const glm::dvec3 helper = std::abs(travel.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(helper, travel));
    return {across, glm::cross(travel, across), travel};
}

/// The box round an instance's volume, by axes across the light and along it [m].
struct LitBox {
    glm::dvec3 lower, upper;
};

LitBox boxOf(const cloud::Instance& instance, const glm::dmat3& toLight) {
    const glm::dvec3 middle = toLight * instance.middle();
    const glm::dmat3 edges = toLight * instance.voxelToMetres;
    // the interpolated density reaches half a voxel beyond the volume, the texels of a shadow volume one more
    const glm::dvec3 half = 0.5 * glm::dvec3(instance.asset->size) + 2.0;
    const glm::dvec3 reach = glm::abs(edges[0]) * half.x + glm::abs(edges[1]) * half.y + glm::abs(edges[2]) * half.z;
    return {middle - reach, middle + reach};
}

/// Whether something of `occluder` may lie between a point of `shaded` and the sun.
bool mayShade(const LitBox& occluder, const LitBox& shaded) {
    return occluder.lower.x < shaded.upper.x && occluder.upper.x > shaded.lower.x &&
           occluder.lower.y < shaded.upper.y && occluder.upper.y > shaded.lower.y && occluder.lower.z < shaded.upper.z;
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
    const glm::dmat3 matrix = voxelToTexel * voxelToVoxel * from.gridToVoxel;
    const glm::dvec3 offset = voxelToTexel * (voxelToVoxel * from.originVoxel + apart - to.originVoxel) + 0.5;
    for (int row = 0; row < 3; ++row)
        place.texelToTexel[row] = glm::vec4(glm::dvec4(matrix[0][row], matrix[1][row], matrix[2][row], offset[row]));
    return place;
}

}  // namespace

Occluders findOccluders(std::span<const Shading> all, const glm::dvec3& sunTravel) {
    const glm::dmat3 toLight = glm::transpose(lightFrame(sunTravel));
    std::vector<LitBox> boxes;
    for (const Shading& one : all) boxes.push_back(boxOf(*one.instance, toLight));
    Occluders found;
    for (std::size_t i = 0; i < all.size(); ++i) {
        found.first.push_back(static_cast<std::uint32_t>(found.numbers.size()));
        if (all[i].shadow == nullptr) continue;
        for (std::size_t j = 0; j < all.size(); ++j) {
            if (j == i || all[j].shadow == nullptr || !mayShade(boxes[j], boxes[i])) continue;
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
        found.places[i].origin = glm::vec4(glm::vec3(own_->origin(found.numbers[i])), 0.0F);
        found.places[i].size = glm::vec4(glm::vec3(images[found.numbers[i]]->extent()), 0.0F);
    }
    occluders_.reset();
    occluders_.emplace(context_, "occluders", shared::OCCLUDER_TEXELS * std::max<std::size_t>(1, found.places.size()),
                       VK_FORMAT_R32G32B32A32_SFLOAT, gpu::Memory::device);
    if (!found.places.empty()) gpu::upload(context_, *occluders_, found.places);
    own_->record(commands, images);
    commands.pass("shared shadow");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::uint32_t first = found.first[i], count = found.first[i + 1] - first;
        if (all[i].shadow == nullptr) continue;
        const glm::ivec3 size = images[i]->extent();
        const auto segments =
            static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
            static_cast<std::uint64_t>((size.z + shared::SHADOW_SEGMENT - 1) / shared::SHADOW_SEGMENT);
        commands.dispatch(program_,
                          {{"own", own_->image(), gpu::Sampler::linearClamp},
                           {"together", together_->image()},
                           {"occluders", *occluders_}},
                          {size, together_->origin(i), first, count}, gpu::linearGroups(segments, 64));
        commands.barrier("shared shadow volume");
    }
}

}  // namespace lumulus::light
