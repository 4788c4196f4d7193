#include "volume/between_files.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "vdb/transform.h"
#include "volume/motion.h"

namespace lumulus {

namespace {

constexpr double bytesPerMiB = 1048576.0, bytesOfVoxel = 2.0;
constexpr double longestSide = 2048.0;  // of a 3D texture

/// One of the two files.
struct End {
    End(const scene::Cloud& of, std::size_t index, double memoryBudget, const vdb::ReadLimits& limits)
        : loaded(vdb::load(of.vdb, {.grid = of.grid,
                                    .memoryBudgetMiB = memoryBudget,
                                    .clamp = of.clamp,
                                    .keys = "cloud." + std::to_string(index),
                                    .limits = limits})),
          velocity(of, {loaded.volume.toWorld, loaded.volume.size}, limits),
          toVoxels{glm::inverse(loaded.volume.toWorld.linear), {}} {
        toVoxels.translation = -(toVoxels.linear * loaded.volume.toWorld.translation);
    }

    /// Density at a place, the field carried by so many seconds.
    double densityAt(const glm::dvec3& place, double seconds) const {
        const glm::dvec3 from = velocity.isKnown() ? velocity.carried(place, -seconds) : place;
        const vdb::Volume& volume = loaded.volume;
        const glm::dvec3 at = toVoxels.point(from) - 0.5;
        const glm::dvec3 low = glm::floor(at), share = at - low;
        if (glm::any(glm::lessThan(low, glm::dvec3(0.0))) ||
            glm::any(glm::greaterThanEqual(low + 1.0, glm::dvec3(volume.size))))
            return 0.0;  // the outermost voxels are 0
        double density = 0.0;
        for (int i = 0; i < 8; ++i) {
            const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2), voxel = glm::ivec3(low) + corner;
            const glm::dvec3 each = glm::mix(1.0 - share, share, glm::dvec3(corner));
            density +=
                each.x * each.y * each.z * static_cast<double>(volume.density[volume.index(voxel.x, voxel.y, voxel.z)]);
        }
        return density;
    }

    vdb::LoadResult loaded;
    CloudVelocity velocity;
    vdb::Affine toVoxels;
};

/// The box of both in voxels of the first, with a ring round it.
void unite(const End& first, const End& second, glm::dvec3& lower, glm::dvec3& upper) {
    lower = glm::dvec3(0.0);
    upper = glm::dvec3(first.loaded.volume.size);
    const vdb::Volume& other = second.loaded.volume;
    for (int i = 0; i < 8 && !other.empty(); ++i) {
        const glm::dvec3 corner = glm::dvec3(other.size) * glm::dvec3(i & 1, (i >> 1) & 1, i >> 2);
        const glm::dvec3 at = first.toVoxels.point(other.toWorld.point(corner));
        lower = glm::min(lower, at);
        upper = glm::max(upper, at);
    }
    constexpr double rounding = 1e-6;
    lower = glm::floor(lower + rounding) - 1.0;
    upper = glm::ceil(upper - rounding) + 1.0;
}

}  // namespace

vdb::LoadResult loadBetween(const scene::Cloud& cloud, std::size_t index, double memoryBudget,
                            const vdb::ReadLimits& limits) {
    scene::Cloud behind = cloud;
    behind.vdb = cloud.moment->next;
    const End first(cloud, index, memoryBudget, limits), second(behind, index, memoryBudget, limits);
    const double share = cloud.moment->share(), seconds = 1.0 / cloud.moment->fps;
    glm::dvec3 lower, upper;
    unite(first, second, lower, upper);
    double edge = 1.0;  // of a voxel, in those of the first file
    const auto sizeAt = [&](double e) { return glm::ceil((upper - lower) / e); };
    const auto fits = [&](const glm::dvec3& size) {
        return size.x * size.y * size.z * bytesOfVoxel <= memoryBudget * bytesPerMiB &&
               std::max({size.x, size.y, size.z}) <= longestSide;
    };
    while (!fits(sizeAt(edge)) && edge < longestSide) edge *= 2.0;

    vdb::LoadResult result;
    result.warnings = first.loaded.warnings;
    for (const std::string& warning : second.loaded.warnings)
        if (std::ranges::find(result.warnings, warning) == result.warnings.end()) result.warnings.push_back(warning);
    result.gridToWorld = first.loaded.gridToWorld;
    result.voxelToGrid = vdb::composed(first.loaded.voxelToGrid, {glm::dmat3(edge), lower});
    vdb::Volume& volume = result.volume;
    volume.name = first.loaded.volume.name;
    volume.size = glm::ivec3(sizeAt(edge));
    volume.toWorld = vdb::composed(result.gridToWorld, result.voxelToGrid);
    volume.density.resize(volume.index(0, 0, volume.size.z));
    std::vector<float> most(static_cast<std::size_t>(volume.size.z));
    tbb::parallel_for(1, volume.size.z - 1, [&](int z) {
        limits.check();
        for (int y = 1; y < volume.size.y - 1; ++y)
            for (int x = 1; x < volume.size.x - 1; ++x) {
                const glm::dvec3 place = volume.toWorld.point(glm::dvec3(x, y, z) + 0.5);
                const double density = (1.0 - share) * first.densityAt(place, share * seconds) +
                                       share * second.densityAt(place, (share - 1.0) * seconds);
                const auto value = static_cast<float>(density);
                volume.density[volume.index(x, y, z)] = value;
                most[static_cast<std::size_t>(z)] = std::max(most[static_cast<std::size_t>(z)], value);
            }
    });
    volume.maximum = std::ranges::max(most);
    result.wantedMiB = bytesOfVoxel * static_cast<double>(volume.density.size()) / bytesPerMiB;
    return result;
}

}  // namespace lumulus
