#include "cloud/level_of_detail.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

namespace lumulus::cloud {

namespace {

/// Voxels along the longest side that every level has at least.
constexpr int fewestVoxels = 4;

/// Optical thickness of a voxel of a coarse level at most.
constexpr double thickestVoxel = 2.0;

}  // namespace

int levelOfDetail(int longestSide, double voxelPixels) {
    int level = 0;
    while (level < coarsestLevel && voxelPixels * std::ldexp(1.0, level + 1) <= 1.0 &&
           (longestSide >> (level + 1)) >= fewestVoxels)
        ++level;
    return level;
}

int levelOfThickness(double voxelThickness) {
    int level = 0;
    while (level < coarsestLevel && std::ldexp(voxelThickness, level + 1) <= thickestVoxel) ++level;
    return level;
}

int collectorsFor(double pixels) {
    return static_cast<int>(std::min(30.0 + 0.4 * pixels * pixels, 1e9));
}

vdb::Volume coarsened(const vdb::Volume& volume, int level) {
    const int edge = 1 << level;
    vdb::Volume coarse;
    coarse.name = volume.name;
    coarse.size = (volume.size + edge - 1) / edge;
    coarse.toWorld = coarsened(volume.toWorld, level);
    std::vector<double> sums(static_cast<std::size_t>(glm::compMul(coarse.size)), 0.0);
    for (int z = 0; z < volume.size.z; ++z)
        for (int y = 0; y < volume.size.y; ++y)
            for (int x = 0; x < volume.size.x; ++x)
                sums[coarse.index(x / edge, y / edge, z / edge)] +=
                    static_cast<double>(volume.density[volume.index(x, y, z)]);
    const double share = std::pow(static_cast<double>(edge), -3);
    for (const double sum : sums) coarse.density.push_back(static_cast<float>(share * sum));
    coarse.maximum = *std::ranges::max_element(coarse.density);
    return coarse;
}

}  // namespace lumulus::cloud
