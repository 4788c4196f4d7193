#pragma once

#include "vdb/volume.h"

namespace lumulus {

/// A homogeneous ball of density 1 and radius `radius` metres about the origin in a cube of n³ voxels, each with the
/// share of it that the ball covers; the voxels just hold it and the ring of zeros.
inline vdb::Volume ballVolume(int n, double radius) {
    constexpr int parts = 6;
    vdb::Volume volume;
    volume.size = glm::ivec3(n);
    volume.density.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n),
                          0.0F);
    volume.maximum = 1.0F;
    const double voxel = 2.0 * radius / (n - 2);
    volume.toWorld.linear = glm::dmat3(voxel);
    volume.toWorld.translation = glm::dvec3(-0.5 * voxel * n);
    for (int z = 1; z < n - 1; ++z) {
        for (int y = 1; y < n - 1; ++y) {
            for (int x = 1; x < n - 1; ++x) {
                int inside = 0;
                for (int i = 0; i < parts * parts * parts; ++i) {
                    const glm::dvec3 part(i % parts, i / parts % parts, i / parts / parts);
                    const glm::dvec3 point = volume.toWorld.point(glm::dvec3(x, y, z) + (part + 0.5) / double{parts});
                    if (glm::length(point) < radius) ++inside;
                }
                volume.density[volume.index(x, y, z)] = static_cast<float>(inside) / (parts * parts * parts);
            }
        }
    }
    return volume;
}

/// A box of density 1, `inner` voxels along each axis without the ring, of voxels of 1 m, its corner at (1, 1, 1).
inline vdb::Volume boxVolume(const glm::ivec3& inner) {
    vdb::Volume volume;
    volume.size = inner + 2;
    volume.density.assign(static_cast<std::size_t>(volume.size.x) * static_cast<std::size_t>(volume.size.y) *
                              static_cast<std::size_t>(volume.size.z),
                          0.0F);
    volume.maximum = 1.0F;
    for (int z = 1; z <= inner.z; ++z) {
        for (int y = 1; y <= inner.y; ++y) {
            for (int x = 1; x <= inner.x; ++x) volume.density[volume.index(x, y, z)] = 1.0F;
        }
    }
    return volume;
}

}  // namespace lumulus
