#pragma once

#include <span>

#include "cloud/atlas.h"
#include "cloud/instance.h"

namespace lumulus::cloud {

/// The volumes of the assets of several instances, in one image each, for shaders that go from instance to instance.
struct SharedVolumes {
    Atlas densities, majorants;
    Atlas collectors;  ///< index of the collector of each voxel, at the place of its density
};

/// `instances` have assets. Errors: Error where a volume does not fit into an image of the device.
SharedVolumes makeSharedVolumes(gpu::Context& context, std::span<const Instance* const> instances);

}  // namespace lumulus::cloud
