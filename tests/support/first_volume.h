#pragma once

#include <utility>

#include "volume/load.h"

namespace lumulus::test {

/// The density of a scene's first cloud, where the scene places it. Errors: those of loadClouds.
inline vdb::Volume firstVolume(const scene::Scene& scene) {
    CloudVolumes clouds = loadClouds(scene);
    const CloudVolumes::Cloud& first = clouds.clouds.at(0);
    vdb::Volume volume = *clouds.volumes.at(first.volume);
    volume.toWorld = first.toWorld;
    return volume;
}

}  // namespace lumulus::test
