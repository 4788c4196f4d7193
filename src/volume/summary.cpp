#include "volume/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>

#include "base/text.h"
#include "scene/scene.h"
#include "volume/load.h"

namespace lumulus {
namespace {

std::string shown(const std::string& name) {
    constexpr std::size_t longest = 120;
    return shortened(oneLine(name), longest);
}

BrickSummary summaryOf(const vdb::SparseVolume& volume) {
    BrickSummary summary;
    summary.leaves = volume.leaves.leaves.size();
    summary.dense = volume.counts.dense;
    summary.constant = volume.counts.constant;
    summary.empty = volume.counts.empty;
    std::ranges::copy(volume.counts.slots, summary.levels.begin());
    summary.bytesOfTexel = static_cast<int>(vdb::texelBytes(volume.format));
    summary.poolBytes = volume.poolBytes();
    summary.indexBytes = summary.collectorIndexBytes = volume.indexBytes();
    summary.majorantBytes = volume.gpuBytes() - summary.poolBytes - 2 * summary.indexBytes;
    return summary;
}

}  // namespace

std::vector<CloudSummary> summarise(const scene::Scene& scene, const CloudVolumes& volumes) {
    std::vector<CloudSummary> clouds;
    for (std::size_t i = 0; i < volumes.clouds.size(); ++i) {
        const CloudVolumes::Cloud& cloud = volumes.clouds[i];
        clouds.push_back({scene::nameOf(scene, i),
                          scene.clouds[i].voxels ? scene.clouds[i].voxels->name : scene.clouds[i].vdb.string(),
                          volumes.volumes[cloud.volume]->name,
                          cloud.thickness.largestOfAll(),
                          cloud.thickness.meanOfAll(),
                          {}});
        if (volumes.isSparse()) clouds.back().bricks = summaryOf(volumes.bricks[cloud.volume]);
    }
    return clouds;
}

std::string lineOf(const CloudSummary& cloud) {
    const std::string source = cloud.file.empty()
                                   ? fmt::format("procedural {}", cloud.grid)
                                   : fmt::format("grid \"{}\" of {}", shown(cloud.grid), shown(cloud.file));
    return fmt::format("cloud {}: {}, optical thickness at most {:.3g}, {:.3g} on average", cloud.name, source,
                       cloud.largestThickness, cloud.meanThickness);
}

std::string gridNames(std::span<const CloudSummary> clouds) {
    constexpr std::size_t most = 256;  // as many as a scene can name one by one
    if (clouds.size() == 1) return clouds.front().grid;
    std::string text;
    for (const CloudSummary& cloud : clouds.first(std::min(clouds.size(), most)))
        text += fmt::format("{}cloud.{}: {}", text.empty() ? "" : ", ", cloud.name, cloud.grid);
    if (clouds.size() > most) text += fmt::format(", {} more", clouds.size() - most);
    return text;
}

std::vector<std::string> warningsOf(std::span<const CloudSummary> clouds) {
    constexpr double visible = 0.01, faint = 0.1, penetrable = 1000.0;
    std::vector<std::string> warnings;
    std::set<std::string> faintOnes, denseOnes;  // instances of one cloud are warned of once
    for (const CloudSummary& cloud : clouds) {
        const std::string of = cloud.name.substr(0, cloud.name.find('['));
        const double most = cloud.largestThickness, mean = cloud.meanThickness;
        if (most > 0.0 && mean < visible && most < faint && faintOnes.insert(of).second)
            warnings.push_back(fmt::format(
                "the optical thickness of cloud.{0} is {1:.2g} on average and {2:.2g} at most: next to nothing will be "
                "seen; raise cloud.{3}.density_scale or cloud.{3}.extinction, or enlarge it by cloud.{3}.transform "
                "(lengths are metres)",
                cloud.name, mean, most, of));
        if (most > penetrable && denseOnes.insert(of).second)
            warnings.push_back(fmt::format(
                "the optical thickness of cloud.{0} is up to {1:.2g}: next to no light gets in, and tracing takes "
                "long; lower cloud.{2}.density_scale or cloud.{2}.extinction, or shrink it by cloud.{2}.transform "
                "(lengths are metres)",
                cloud.name, most, of));
    }
    return warnings;
}

}  // namespace lumulus
