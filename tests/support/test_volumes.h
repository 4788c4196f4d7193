#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "vdb/volume.h"

namespace lumulus::test {

/// A volume of zeros with the given voxel edges (columns) in metres.
inline vdb::Volume emptyVolume(const glm::ivec3& size, const glm::dmat3& edges = glm::dmat3(1.0)) {
    vdb::Volume volume;
    volume.size = size;
    volume.density.assign(
        static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z), 0.0F);
    volume.toWorld.linear = edges;
    return volume;
}

/// Sets all voxels but the ring to `density(voxel)`, and the maximum.
template <class Density>
void fillVolume(vdb::Volume& volume, const Density& density) {
    volume.maximum = 0.0F;
    for (int z = 1; z < volume.size.z - 1; ++z)
        for (int y = 1; y < volume.size.y - 1; ++y)
            for (int x = 1; x < volume.size.x - 1; ++x) {
                const auto value = static_cast<float>(density(glm::ivec3(x, y, z)));
                volume.density[volume.index(x, y, z)] = value;
                volume.maximum = std::max(volume.maximum, value);
            }
}

/// Some soft lumps with empty space between, and grain on them.
inline vdb::Volume lumpyVolume(const glm::ivec3& size, const glm::dmat3& edges, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    struct Lump {
        glm::dvec3 centre;
        double radius, height;
    };
    std::vector<Lump> lumps;
    const double smallest = std::min(size.x, std::min(size.y, size.z));
    for (int i = 0; i < 7; ++i) {
        const glm::dvec3 u(uniform(random), uniform(random), uniform(random));
        lumps.push_back({u * glm::dvec3(size), smallest * (0.15 + 0.2 * uniform(random)), 0.3 + uniform(random)});
    }
    vdb::Volume volume = emptyVolume(size, edges);
    fillVolume(volume, [&](const glm::ivec3& voxel) {
        double sum = 0.0;
        for (const Lump& lump : lumps) {
            const double d = glm::distance(glm::dvec3(voxel) + 0.5, lump.centre) / lump.radius;
            sum += lump.height * std::max(0.0, 1.0 - d * d);
        }
        return sum * (0.6 + 0.4 * uniform(random));
    });
    return volume;
}

}  // namespace lumulus::test
