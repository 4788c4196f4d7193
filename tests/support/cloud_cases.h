#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "cloud/asset.h"
#include "stat/ball.h"
#include "support/test_volumes.h"

namespace lumulus::test {

struct CloudCase {
    std::string name;
    vdb::Volume volume;
    vdb::DensityFormat format;
};

/// A faint cloud with one voxel that is a million times denser: where rejection against the supremum would stall.
inline vdb::Volume spikeVolume() {
    vdb::Volume volume = emptyVolume({50, 47, 52});
    fillVolume(volume, [](const glm::ivec3& v) { return 0.5 + 0.3 * std::sin(0.4 * v.x) * std::sin(0.3 * v.y + v.z); });
    volume.density[volume.index(25, 22, 27)] = 1e6F;
    volume.maximum = 1e6F;
    return volume;
}

/// Volumes in each of the texel formats, with voxels of unequal edges and a sheared grid among them. Sizes are no
/// multiples of the blocks' edge.
inline std::vector<CloudCase> cloudCases() {
    const glm::dmat3 unequal(glm::dvec3(2.0, 0, 0), glm::dvec3(0, 5.0, 0), glm::dvec3(0, 0, 1.0));
    const glm::dmat3 sheared(glm::dvec3(3.0, 0.5, 0), glm::dvec3(1.0, 2.0, 0.3), glm::dvec3(0, -0.4, 2.5));
    std::vector<CloudCase> cases;
    cases.push_back({"box", boxVolume({17, 10, 22}), vdb::DensityFormat::r8});
    cases.push_back({"unequal lumps", lumpyVolume({37, 30, 26}, unequal, 1), vdb::DensityFormat::r16f});
    cases.push_back({"sheared lumps", lumpyVolume({22, 35, 29}, sheared, 2), vdb::DensityFormat::r16f});
    cases.push_back({"spike", spikeVolume(), vdb::DensityFormat::r32f});
    return cases;
}

inline cloud::PrepareOptions prepareOptions(int samples, scene::Majorant majorant = scene::Majorant::automatic) {
    cloud::PrepareOptions options;
    options.preparation.samples = samples;
    options.majorant = majorant;
    return options;
}

}  // namespace lumulus::test
