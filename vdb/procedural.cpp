#include "vdb/procedural.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "base/error.h"
#include "vdb/procedural_kinds.h"

namespace lumulus::vdb {

std::vector<std::string> kinds() {
    return {"cumulus", "stratocumulus", "stratus", "cirrus", "sphere", "slab"};
}

Volume makeBox(const std::string& name, const glm::dvec3& extent, int resolution, double flattening) {
    const double longest = glm::compMax(extent);
    const double width = longest / (resolution - 2);
    const glm::dvec3 voxel(width, width / flattening, width);
    constexpr double rounding = 1e-9;  // an extent that is a whole number of voxels gets no extra one
    const glm::ivec3 inside = glm::max(glm::ivec3(glm::ceil(extent / voxel - rounding)), glm::ivec3(1));

    Volume volume;
    volume.name = name;
    volume.size = inside + 2;
    volume.density.assign(volume.index(0, 0, volume.size.z), 0.0F);
    volume.toWorld.linear = glm::dmat3(voxel.x, 0, 0, 0, voxel.y, 0, 0, 0, voxel.z);
    volume.toWorld.translation = -0.5 * glm::dvec3(volume.size) * voxel;
    volume.toWorld.translation.y = -voxel.y;
    return volume;
}

Volume makeCloud(const ProceduralOptions& options, const Report& report) {
    if (options.resolution < 8 || options.resolution > 1024) {
        throw InputError(fmt::format("resolution {} of a procedural cloud is out of range", options.resolution),
                         "resolution", "choose 8 to 1024 voxels");
    }
    if (options.kind == "cumulus") return makeCumulus(options.resolution, options.seed, report);
    if (options.kind == "stratocumulus") return makeStratocumulus(options.resolution, options.seed, report);
    if (options.kind == "stratus") return makeStratus(options.resolution, options.seed, report);
    if (options.kind == "cirrus") return makeCirrus(options.resolution, options.seed, report);
    if (options.kind == "sphere") return makeSphere(options.resolution, report);
    if (options.kind == "slab") return makeSlab(options.resolution, report);
    std::string known;
    for (const std::string& kind : kinds()) known += (known.empty() ? "" : ", ") + kind;
    throw InputError(fmt::format("no procedural cloud is called \"{}\"", options.kind), "procedural",
                     "choose one of " + known);
}

}  // namespace lumulus::vdb
