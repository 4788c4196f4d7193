#include "surface/mesh/sun_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "surface/mesh/normal_axes.h"

namespace lumulus::surface {
namespace {

namespace spirv {
#include "spirv/mesh/shade_volume.comp.h"
}  // namespace spirv

constexpr int edge = 1024;  // texels along the longer side

/// The box around all meshes by the axes of a map.
struct MapBox {
    glm::dvec3 lower{1e300}, upper{-1e300};

    MapBox(const MeshScene& scene, const glm::dmat3& toMap) {
        const glm::dvec3 low(scene.world.box.lower), high(scene.world.box.upper);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 corner = glm::mix(low, high, glm::dvec3(i & 1, (i >> 1) & 1, i >> 2));
            const glm::dvec3 at = toMap * (scene.world.middle + corner);
            lower = glm::min(lower, at);
            upper = glm::max(upper, at);
        }
    }
    double texel() const { return std::max(1e-6, std::max(upper.x - lower.x, upper.y - lower.y) / (edge - 2)); }
    glm::ivec2 texels() const { return glm::ivec2(glm::ceil(glm::dvec2(upper - lower) / texel())) + 2; }
};

glm::dmat3 mapAxes(const glm::dvec3& toSun) {
    return glm::transpose(NormalAxes(toSun).columns);
}

}  // namespace

SunMap::SunMap(gpu::Context& context, const MeshScene& scene, const glm::dvec3& toSun, const Check& check)
    : toSun_(toSun),
      toMap_(mapAxes(toSun)),
      image_(context, "mesh sun map", MapBox(scene, toMap_).texels(), VK_FORMAT_R32_SFLOAT),
      program_(context, "mesh shadow", spirv::shade_volume_comp) {
    const MapBox box(scene, toMap_);
    texel_ = box.texel();
    corner_ = box.lower - glm::dvec3(texel_, texel_, 0.0);
    const glm::ivec2 texels = box.texels();
    size_ = glm::dvec3(texel_ * glm::dvec2(texels), box.upper.z - box.lower.z);
    const glm::dmat3 toWorld = glm::transpose(toMap_);
    const double above = box.upper.z + 1e-3 * size_.z;
    heights_.assign(static_cast<std::size_t>(texels.x) * static_cast<std::size_t>(texels.y), -3e38F);
    tbb::parallel_for(0, texels.y, [&](int y) {
        check();
        for (int x = 0; x < texels.x; ++x) {
            const glm::dvec2 at = glm::dvec2(corner_) + texel_ * (glm::dvec2(x, y) + 0.5);
            const auto met = scene.meet({toWorld * glm::dvec3(at, above), -toSun}, 1e9);
            if (met)
                heights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(texels.x) +
                         static_cast<std::size_t>(x)] = static_cast<float>(above - met->metres - corner_.z);
        }
    });
    gpu::upload(context, image_, heights_);
}

std::array<glm::vec4, 3> SunMap::rowsFrom(const glm::dvec3& origin) const {
    const glm::dmat3 axes = glm::transpose(toMap_);  // columns are the map's axes
    const glm::dvec3 start = toMap_ * origin - corner_;
    std::array<glm::vec4, 3> rows;
    for (int i = 0; i < 3; ++i) {
        const double scale = i < 2 ? 1.0 / texel_ : 1.0;
        rows[static_cast<std::size_t>(i)] = glm::vec4(glm::dvec4(scale * axes[i], scale * start[i]));
    }
    return rows;
}

/// The same from cells with these edges that begin at a corner.
std::array<glm::vec4, 3> SunMap::rowsOf(const glm::dmat3& cells, const glm::dvec3& corner) const {
    const glm::mat3 linear{cells};
    std::array<glm::vec4, 3> rows = rowsFrom(corner);
    for (glm::vec4& row : rows) row = glm::vec4(glm::vec3(row) * linear, row.w);
    return rows;
}

gpu::Buffer SunMap::forPhotons(gpu::Context& context, const glm::dmat3& cells, const glm::dvec3& corner) const {
    const std::array<glm::vec4, 3> rows = rowsOf(cells, corner);
    const shared::MeshShadeParams params{{rows[0], rows[1], rows[2]}, glm::ivec2(image_.extent())};
    std::vector<std::byte> bytes(sizeof params + heights_.size() * sizeof(float));
    std::memcpy(bytes.data(), &params, sizeof params);
    std::memcpy(bytes.data() + sizeof params, heights_.data(), heights_.size() * sizeof(float));
    return gpu::filledBuffer(context, "mesh shade", bytes);
}

void SunMap::shade(gpu::Commands& commands, const gpu::Image& volume, const glm::ivec3& origin, const glm::ivec3& size,
                   const glm::dmat4& texelToWorld) const {
    const std::array<glm::vec4, 3> rows = rowsOf(glm::dmat3(texelToWorld), glm::dvec3(texelToWorld[3]));
    const shared::MeshVolumePush push{{rows[0], rows[1], rows[2]}, origin, size};
    const auto texels =
        static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * static_cast<std::uint64_t>(size.z);
    commands.pass("mesh shadow");
    commands.dispatch(program_, {{"volume", volume}, {"meshHeights", image_, gpu::Sampler::nearest}}, push,
                      gpu::linearGroups(texels, 64));
}

std::array<glm::vec4, 4> SunMap::boxFrom(const glm::dvec3& origin) const {
    const glm::dmat3 axes = glm::transpose(toMap_);
    const glm::dvec3 start = toMap_ * origin - corner_;
    std::array<glm::vec4, 4> rows;
    for (int i = 0; i < 3; ++i) rows[static_cast<std::size_t>(i)] = glm::vec4(glm::dvec4(axes[i], start[i]));
    rows[3] = glm::vec4(glm::vec3(size_), 0.0F);
    return rows;
}

}  // namespace lumulus::surface
