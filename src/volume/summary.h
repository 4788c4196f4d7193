#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lumulus::scene {
struct Scene;
}

namespace lumulus {

struct CloudVolumes;

/// How a field in bricks is stored.
struct BrickSummary {
    std::uint64_t leaves = 0;                          ///< of 8³ voxels with density
    std::uint64_t dense = 0, constant = 0, empty = 0;  ///< bricks of the box: with texels, of one value, of 0
    std::array<std::uint64_t, 4> levels{};             ///< slots of the pool, by level
    int bytesOfTexel = 0;
    std::uint64_t poolBytes = 0, indexBytes = 0, collectorIndexBytes = 0, majorantBytes = 0;
};

/// What a picture shows of one cloud of the scene.
struct CloudSummary {
    std::string name;                         ///< as nameOf() gives it
    std::string file;                         ///< empty for a procedural cloud
    std::string grid;                         ///< name of the grid that was taken, or the kind of a procedural cloud
    double largestThickness = 0.0;            ///< optical thickness, the largest along the axes of the grid …
    double meanThickness = 0.0;               ///< … and its mean over the columns of voxels that meet the cloud
    std::optional<BrickSummary> bricks = {};  ///< absent where the field is dense
    bool inexact = false;  ///< photon maps make its light wrong by one percent or more; of much a warning tells
};

/// What was prepared of one density field at one level of detail, and for how many clouds of the scene.
struct AssetSummary {
    std::array<int, 3> voxels{};  ///< along each edge
    int level = 0;                ///< edges of its voxels are 2^level times those of the file
    std::uint64_t collectors = 0, instances = 0;
    /// Seconds of each part of the preparation: density onto the GPU, majorants with the bounds of the gradient,
    /// samples of the gradient, the kD-tree over them, and collectors with the leaf of each voxel.
    double upload = 0.0, majorants = 0.0, sampling = 0.0, tree = 0.0, collecting = 0.0;

    /// The same of one that was made before.
    AssetSummary withoutTimes() const { return {voxels, level, collectors, instances}; }
};

/// A function that is told of a scene's clouds as soon as they are loaded, with what is warned of by then.
using ToldOfClouds = std::function<void(std::span<const CloudSummary> clouds, std::span<const std::string> warnings)>;

/// One for each cloud of the scene, in its order.
std::vector<CloudSummary> summarise(const scene::Scene& scene, const CloudVolumes& volumes);

/// A line for a person: name, grid, file and optical thickness.
std::string lineOf(const CloudSummary& cloud);

/// The grids of all clouds for the header of a picture: "density", or "cloud.0: density, cloud.veil: smoke".
std::string gridNames(std::span<const CloudSummary> clouds);

/// Warnings for clouds of which nothing will be seen (an optical thickness below 0.01 on average and below 0.1
/// everywhere) and for those into which next to no light gets (above 1,000 anywhere), one line each with the keys to
/// change. Clouds without any extinction are taken to be wanted so.
std::vector<std::string> warningsOf(std::span<const CloudSummary> clouds);

}  // namespace lumulus
