#include "vdb/billowing.h"
#include "vdb/procedural_kinds.h"

// A cumulus: towers of spheres on spheres.
namespace lumulus::vdb {

Volume makeCumulus(int resolution, std::uint64_t seed, const Report& report) {
    constexpr float width = 1000.0F, height = 650.0F;
    constexpr float margin = 20.0F;  // metres left free at the sides of the box and above
    std::vector<Puff> puffs = growPuffs(seed, width - 2.0F * margin);
    const PuffBounds bounds = boundPuffs(puffs);
    const glm::vec3 extent = bounds.high - bounds.low + 2.0F * margin;
    Volume volume = makeBox("cumulus", glm::dvec3(extent.x, height, extent.z), resolution);
    fillBillowing(volume, std::move(puffs), height - margin, seed, report);
    return volume;
}

}  // namespace lumulus::vdb
