#include "volume/load_bricks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "vdb/load_sparse.h"
#include "view/camera.h"

namespace lumulus {
namespace {

constexpr double bytesPerMiB = 1048576.0;
/// Voxels along a side of a 3D image.
constexpr std::int64_t longestImage = 2048;
/// Roots of an index: a box that has more is next to empty, and averaged instead.
constexpr double mostRoots = 4194304.0;
/// Of the pool: what drivers on the CPU take of one image.
constexpr std::uint64_t mostPoolBytes = std::uint64_t{1} << 30U;

vdb::LoadOptions optionsOf(const Source& source, const vdb::ReadLimits& limits) {
    return {.grid = source.cloud->grid,
            .clamp = source.cloud->clamp,
            .part = source.cloud->part,
            .keys = "cloud." + std::to_string(source.index),
            .limits = limits};
}

/// Where the scene's camera sees the voxels of a cloud.
struct Eye {
    glm::dvec3 voxel{0.0};  ///< its place, in voxels
    glm::dvec3 edges{1.0};  ///< of a voxel [m]
    double angle = 0.0;     ///< of a pixel; 0 where the distance does not count …
    double pixel = 1.0;     ///< … and a pixel is so many metres

    /// Pixels that a voxel of a box covers at most.
    double pixelsOf(const glm::ivec3& minimum, int edge) const {
        const glm::dvec3 low(minimum), high = low + static_cast<double>(edge);
        const double away = glm::length(edges * glm::max(glm::max(low - voxel, voxel - high), 0.0));
        const double longest = std::max({edges.x, edges.y, edges.z});
        return longest / (angle > 0.0 ? std::max(angle * away, 1e-9) : pixel);
    }
};

Eye eyeOf(const Camera& camera, const vdb::Affine& toWorld) {
    Eye eye;
    eye.voxel = glm::inverse(toWorld.linear) * (camera.position - toWorld.translation);
    for (int axis = 0; axis < 3; ++axis) eye.edges[axis] = glm::length(toWorld.linear[axis]);
    constexpr double pi = 3.14159265358979323846;
    if (camera.projection == scene::Projection::orthographic)
        eye.pixel = camera.orthographicHeight / camera.height;
    else
        eye.angle = (camera.projection == scene::Projection::panorama ? pi : 2.0 * camera.tanHalfFov) / camera.height;
    return eye;
}

/// A texel of the level covers at most so many pixels, for all clouds that show the field.
vdb::LevelRule ruleFor(const std::vector<Eye>& eyes, double pixels) {
    return [eyes, pixels](const glm::ivec3& minimum, int edge) {
        double largest = 1e-30;
        for (const Eye& eye : eyes) largest = std::max(largest, eye.pixelsOf(minimum, edge));
        return std::clamp(static_cast<int>(std::floor(std::log2(pixels / largest))), 0, vdb::SparseVolume::mostLevel);
    };
}

class Layer {
  public:
    Layer(const scene::Scene& scene, CloudVolumes& volumes, const Check& check)
        : volumes_(volumes),
          check_(check),
          budget_(scene.preparation.memoryBudget * bytesPerMiB),
          eyes_(volumes.bricks.size()) {
        const Camera camera = makeCamera(scene.camera, scene.image, boundsOf(volumes.placed()));
        for (const CloudVolumes::Cloud& cloud : volumes.clouds)
            eyes_[cloud.volume].push_back(eyeOf(camera, cloud.toWorld));
    }

    void lay() {
        layAll(0.0);
        const double wanted = bytes();
        if (fits()) return;
        // steps of half a level from a thousandth of a pixel to all that there is
        int low = -20, high = 60;
        layAll(pixelsAt(high));
        if (!fits())
            throw InputError(
                fmt::format("at the coarsest level densities still take {:.0f} MiB, the budget is {:.0f} MiB",
                            std::ceil(bytes() / bytesPerMiB), budget_ / bytesPerMiB),
                "preparation.memory_budget", "raise it, or set preparation.storage = \"dense\"");
        while (high - low > 1) {
            const int middle = (low + high) / 2;
            layAll(pixelsAt(middle));
            (fits() ? high : low) = middle;
        }
        layAll(pixelsAt(high));
        warn(wanted, pixelsAt(high));
    }

  private:
    static double pixelsAt(int step) { return std::exp2(0.5 * step); }

    void layAll(double pixels) {
        for (std::size_t i = 0; i < volumes_.bricks.size(); ++i)
            vdb::layOut(volumes_.bricks[i], pixels > 0.0 ? ruleFor(eyes_[i], pixels) : vdb::LevelRule(), check_);
    }

    double bytes() const {
        double sum = 0.0;
        for (const vdb::SparseVolume& volume : volumes_.bricks) sum += static_cast<double>(volume.gpuBytes());
        return sum;
    }

    bool fits() const {
        std::uint64_t pool = 0;
        for (const vdb::SparseVolume& volume : volumes_.bricks) pool += volume.poolBytes();
        return bytes() <= budget_ && pool <= mostPoolBytes;
    }

    void warn(double wanted, double pixels) {
        vdb::SparseVolume::Counts all;
        for (const vdb::SparseVolume& volume : volumes_.bricks)
            for (int level = 0; level <= vdb::SparseVolume::mostLevel; ++level)
                all.slots[level] += volume.counts.slots[level];
        volumes_.warnings.push_back(fmt::format(
            "densities would take {:.0f} MiB: {} bricks are stored as they are, and {}, {} and {} of 2, 4 and 8 times "
            "their edge where a voxel is smaller than {:.2g} pixels; preparation.memory_budget = {:.0f} keeps all",
            wanted / bytesPerMiB, all.slots[0], all.slots[1], all.slots[2], all.slots[3], pixels,
            std::ceil(wanted / bytesPerMiB)));
    }

    CloudVolumes& volumes_;
    const Check& check_;
    double budget_;
    std::vector<std::vector<Eye>> eyes_;  ///< of each field
};

}  // namespace

bool wantsBricks(const scene::Preparation& preparation, const std::vector<Source>& sources,
                 const vdb::ReadLimits& limits) {
    if (preparation.storage != scene::DensityStorage::automatic)
        return preparation.storage == scene::DensityStorage::sparse;
    double denseMiB = 0.0;
    bool large = false;
    for (const Source& source : sources) {
        if (!source.isFile()) continue;
        const vdb::GridOutline outline = vdb::outline(source.cloud->vdb, optionsOf(source, limits));
        if (outline.roots > mostRoots) return false;
        denseMiB += outline.denseMiB;
        large = large || outline.longest > longestImage;
    }
    return large || denseMiB > preparation.memoryBudget;
}

void readBricks(Source& source, const Report& report, const vdb::ReadLimits& limits) {
    report("loading the cloud", 0, 1);
    vdb::SparseResult result = vdb::loadSparse(source.cloud->vdb, optionsOf(source, limits));
    source.bricks = std::move(result.volume);
    vdb::Volume volume;
    volume.size = source.bricks.size;
    volume.maximum = source.bricks.maximum;
    volume.toWorld = source.bricks.toWorld;
    volume.name = source.bricks.name;
    source.volume = std::make_shared<const vdb::Volume>(std::move(volume));
    source.loaded.gridToWorld = result.gridToWorld;
    source.loaded.voxelToGrid = result.voxelToGrid;
    source.loaded.warnings = std::move(result.warnings);
    report("loading the cloud", 1, 1);
}

void layBricks(const scene::Scene& scene, CloudVolumes& volumes, const Check& check) {
    for (std::size_t i = 0; i < volumes.bricks.size(); ++i) {
        vdb::SparseVolume& bricks = volumes.bricks[i];
        const vdb::Volume& volume = *volumes.volumes[i];
        if (!volume.density.empty()) {  // a procedural cloud
            bricks.size = volume.size;
            bricks.maximum = volume.maximum;
            bricks.toWorld = volume.toWorld;
            bricks.name = volume.name;
            bricks.leaves = vdb::leavesOf(volume);
        }
        bricks.format = vdb::chooseFormat(bricks.leaves);
    }
    Layer(scene, volumes, check).lay();
}

}  // namespace lumulus
