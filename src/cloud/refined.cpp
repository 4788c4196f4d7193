#include "cloud/refined.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "cloud/voxel_shape.h"

namespace lumulus::cloud {

namespace {

/// Optical thickness of an edge that is fine enough.
constexpr double thin = 0.5;
constexpr double mostVoxels = 8.0 * 1024 * 1024;
constexpr int mostParts = 15;

/// Along one axis: the two voxels between whose middles that of a part lies, and the share of the second.
struct Between {
    int first, second;
    float share;
};

Between between(int part, int parts, int size) {
    const double at = (part + 0.5) / parts - 0.5;  // in middles of voxels
    const int first = static_cast<int>(std::floor(at));
    return {std::clamp(first, 0, size - 1), std::clamp(first + 1, 0, size - 1), static_cast<float>(at - first)};
}

}  // namespace

glm::ivec3 refinement(const glm::ivec3& size, const glm::dmat3& edges, double extinction) {
    glm::ivec3 parts(1);
    if (!hasFlatVoxels(edges) || !(extinction > 0.0)) return parts;
    const double wanted = std::max(shortestEdge(edges), thin / extinction);
    const auto voxels = [&](const glm::ivec3& p) { return glm::compMul(glm::dvec3(size * p)); };
    for (bool more = true; more;) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (glm::length(edges[axis]) / parts[axis] > glm::length(edges[longest]) / parts[longest]) longest = axis;
        glm::ivec3 next = parts;
        next[longest] += 2;
        more = glm::length(edges[longest]) / parts[longest] > 1.5 * wanted && next[longest] <= mostParts &&
               voxels(next) <= mostVoxels;
        if (more) parts = next;
    }
    return parts;
}

scene::PhotonMap forFlatVoxels(const scene::PhotonMap& map) {
    scene::PhotonMap flat = map;
    constexpr int bands = 8;
    constexpr double cut = 6.0;
    constexpr std::int64_t factor = 3, enough = 6'000'000;
    if (!map.directionsGiven) {
        flat.bands = std::max(map.bands, bands);
        flat.forwardCut = std::min(map.forwardCut, cut);
    }
    if (!map.photonsGiven) flat.photons = std::max(map.photons, std::min(factor * map.photons, enough));
    return flat;
}

vdb::Volume refined(const vdb::Volume& volume, const glm::ivec3& parts) {
    vdb::Volume fine;
    fine.name = volume.name;
    fine.size = volume.size * parts;
    fine.toWorld = refined(volume.toWorld, parts);
    fine.maximum = volume.maximum;
    fine.density.resize(static_cast<std::size_t>(glm::compMul(glm::i64vec3(fine.size))));
    tbb::parallel_for(0, fine.size.z, [&](int z) {
        const Between k = between(z, parts.z, volume.size.z);
        for (int y = 0; y < fine.size.y; ++y) {
            const Between j = between(y, parts.y, volume.size.y);
            for (int x = 0; x < fine.size.x; ++x) {
                const Between i = between(x, parts.x, volume.size.x);
                const auto along = [&](int row, int layer) {
                    return glm::mix(volume.density[volume.index(i.first, row, layer)],
                                    volume.density[volume.index(i.second, row, layer)], i.share);
                };
                fine.density[fine.index(x, y, z)] =
                    glm::mix(glm::mix(along(j.first, k.first), along(j.second, k.first), j.share),
                             glm::mix(along(j.first, k.second), along(j.second, k.second), j.share), k.share);
            }
        }
    });
    return fine;
}

}  // namespace lumulus::cloud
