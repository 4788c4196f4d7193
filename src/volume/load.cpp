#include "volume/load.h"

#include "base/error.h"
#include "vdb/load.h"
#include "vdb/procedural.h"

namespace lumulus {

CloudVolume loadCloudVolume(const scene::Cloud& cloud, double memoryBudget, const Report& report) {
    if (!cloud.vdb.empty()) {
        vdb::LoadOptions options;
        options.grid = cloud.grid;
        options.transform = cloud.transform;
        options.memoryBudgetMiB = memoryBudget;
        report("loading the cloud", 0, 1);
        vdb::LoadResult loaded = vdb::load(cloud.vdb, options);
        report("loading the cloud", 1, 1);
        return {std::move(loaded.volume), std::move(loaded.warnings)};
    }
    CloudVolume made;
    made.volume = vdb::makeCloud({cloud.procedural, cloud.resolution, cloud.seed}, report);
    const glm::dmat3 linear(cloud.transform);
    if (!(glm::determinant(linear) != 0.0))
        throw InputError("the transform is singular", "cloud.0.transform", "give one that can be inverted");
    made.volume.toWorld = {linear * made.volume.toWorld.linear,
                           linear * made.volume.toWorld.translation + glm::dvec3(cloud.transform[3])};
    return made;
}

}  // namespace lumulus
