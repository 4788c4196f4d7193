#include <cmath>

#include "vdb/procedural_kinds.h"

// The homogeneous shapes, for tests and for measuring.
namespace lumulus::vdb {
namespace {

/// Fraction of the cube around `middle` (edge `edge`) inside the ball around `centre`. The cube is split until its part
/// of the surface is nearly flat; there the covered fraction falls linearly with the distance.
double ballCoverage(const glm::dvec3& middle, double edge, const glm::dvec3& centre, double radius, int splits) {
    const double distance = glm::length(middle - centre) - radius;
    const double halfDiagonal = 0.5 * std::sqrt(3.0) * edge;
    if (distance >= halfDiagonal) return 0.0;
    if (distance <= -halfDiagonal) return 1.0;
    if (splits == 0) return glm::clamp(0.5 - distance / edge, 0.0, 1.0);
    double sum = 0.0;
    for (int octant = 0; octant < 8; ++octant) {
        const glm::dvec3 side(octant & 1, (octant >> 1) & 1, (octant >> 2) & 1);
        sum += ballCoverage(middle + (side - 0.5) * (0.5 * edge), 0.5 * edge, centre, radius, splits - 1);
    }
    return sum / 8.0;
}

}  // namespace

Volume makeSphere(int resolution, const Report& report) {
    constexpr double radius = 100.0;
    constexpr int splits = 4;
    Volume volume = makeBox("sphere", glm::dvec3(2.0 * radius), resolution);
    const double edge = volume.toWorld.linear[0][0];
    fillVoxels(volume, report, [&](int x, int y, int z) {
        const glm::dvec3 middle = volume.toWorld.point(glm::dvec3(x, y, z) + 0.5);
        return static_cast<float>(ballCoverage(middle, edge, glm::dvec3(0.0, radius, 0.0), radius, splits));
    });
    return volume;
}

Volume makeSlab(int resolution, const Report& report) {
    const glm::dvec3 extent(400.0, 100.0, 400.0);
    Volume volume = makeBox("slab", extent, resolution);
    const glm::dvec3 low(-0.5 * extent.x, 0.0, -0.5 * extent.z);
    fillVoxels(volume, report, [&](int x, int y, int z) {
        const glm::dvec3 from = volume.toWorld.point(glm::dvec3(x, y, z));
        const glm::dvec3 to = volume.toWorld.point(glm::dvec3(x, y, z) + 1.0);
        const glm::dvec3 covered = (glm::min(to, low + extent) - glm::max(from, low)) / (to - from);
        const glm::dvec3 fraction = glm::clamp(covered, glm::dvec3(0.0), glm::dvec3(1.0));
        return static_cast<float>(fraction.x * fraction.y * fraction.z);
    });
    return volume;
}

}  // namespace lumulus::vdb
