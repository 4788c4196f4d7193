#include "volume/load.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "vdb/load.h"
#include "vdb/load_array.h"
#include "vdb/procedural.h"
#include "vdb/transform.h"
#include "volume/between_files.h"
#include "volume/known_fields.h"
#include "volume/load_bricks.h"
#include "volume/source.h"
#include "volume/summary.h"

namespace lumulus {
namespace {

constexpr double bytesPerMiB = 1048576.0;

/// MiB at the two bytes that a voxel takes on the GPU.
double sizeOf(const vdb::Volume& volume) {
    const glm::dvec3 size(volume.size);
    return 2.0 * size.x * size.y * size.z / bytesPerMiB;
}

vdb::DensityArray arrayOf(const scene::Voxels& voxels) {
    return {voxels.name, voxels.size, voxels.edges, voxels.origin, voxels.values};
}

vdb::LoadResult load(const scene::Cloud& cloud, std::size_t index, double memoryBudget, const Report& report,
                     const vdb::ReadLimits& limits) {
    if (cloud.voxels || !cloud.vdb.empty()) {
        report("loading the cloud", 0, 1);
        const vdb::LoadOptions options{.grid = cloud.grid,
                                       .memoryBudgetMiB = memoryBudget,
                                       .clamp = cloud.clamp,
                                       .part = cloud.part,
                                       .keys = "cloud." + std::to_string(index),
                                       .limits = limits};
        const bool between = cloud.moment && !cloud.moment->next.empty();
        vdb::LoadResult loaded = cloud.voxels ? vdb::loadArray(arrayOf(*cloud.voxels), options)
                                 : between    ? loadBetween(cloud, index, memoryBudget, limits)
                                              : vdb::load(cloud.vdb, options);
        report("loading the cloud", 1, 1);
        return loaded;
    }
    vdb::LoadResult made;
    made.volume = vdb::makeCloud({cloud.procedural, cloud.resolution, cloud.seed}, report);
    made.gridToWorld = made.volume.toWorld;
    made.wantedMiB = sizeOf(made.volume);
    return made;
}

/// The most that one of several may take of a budget, so that those that want less get what they want and the others
/// the same.
double evenShare(std::vector<double> wanted, double budget) {
    std::ranges::sort(wanted);
    auto left = static_cast<double>(wanted.size());
    for (const double want : wanted) {
        if (want * left > budget) break;
        budget -= want;
        left -= 1.0;
    }
    return left > 0.0 ? std::max(budget, 0.0) / left : budget;
}

bool isKnown(const KnownField& field, const Source& source) {
    return field.index == source.index && sourceOf(field.cloud) == sourceOf(*source.cloud);
}

/// Loads the dense field of a source, or takes one that is known.
void fill(Source& source, double budget, const Report& report, const vdb::ReadLimits& limits, const KnownFields* known,
          bool inBricks = false) {
    source.budget = budget;
    if (known != nullptr)
        for (const KnownField& field : known->fields) {
            if (field.budget != budget || field.inBricks != inBricks || !isKnown(field, source)) continue;
            source.loaded = field.loaded;
            source.volume = field.volume;
            source.sums = field.sums;
            source.filled = field.filled;
            return;
        }
    source.volume.reset();
    source.loaded = load(*source.cloud, source.index, budget, report, limits);
    source.volume = std::make_shared<const vdb::Volume>(std::move(source.loaded.volume));
    source.loaded.volume = {};
}

/// Takes the volume of a field in bricks from before, where it is the same.
void recognise(Source& source, const KnownFields& known) {
    for (const KnownField& field : known.fields) {
        const vdb::Volume &before = *field.volume, &now = *source.volume;
        const bool same = before.size == now.size && before.maximum == now.maximum && before.name == now.name &&
                          before.toWorld.linear == now.toWorld.linear &&
                          before.toWorld.translation == now.toWorld.translation;
        if (field.inBricks && same && isKnown(field, source)) source.volume = field.volume;
    }
}

/// Loads all sources. Only so much is held at a time as the budget and one more field take.
void loadAll(std::vector<Source>& sources, double budget, const Report& report, const vdb::ReadLimits& limits,
             const KnownFields* known) {
    double held = 0.0, total = 0.0, left = budget;
    std::vector<double> wanted;
    for (Source& source : sources) {
        fill(source, budget, report, limits, known);
        const double size = sizeOf(*source.volume);
        total += source.loaded.wantedMiB;
        if (source.isFile()) {
            wanted.push_back(source.loaded.wantedMiB);
        } else {
            left -= source.loaded.wantedMiB;
        }
        const bool drop = source.isFile() && sources.size() > 1 && held + size > budget;
        if (drop) source.volume.reset();
        held += drop ? 0.0 : size;
    }
    if (sources.size() < 2 || total <= budget) return;
    const double share = evenShare(std::move(wanted), left);
    for (Source& source : sources) {
        if (!source.isFile() || (source.volume && sizeOf(*source.volume) <= share)) continue;
        fill(source, share, report, limits, known);
    }
}

/// Where the keys of a cloud stand in the scene: "cloud.veil" for veil and for its instances veil[0], veil[1] and so
/// on.
std::string keysOf(const scene::Scene& scene, std::size_t cloud) {
    const std::string name = scene::nameOf(scene, cloud);
    return "cloud." + name.substr(0, name.find('['));
}

/// The different sources of the clouds; `volumeOf` becomes the index of each cloud's.
std::vector<Source> differentSources(const std::vector<scene::Cloud>& clouds, std::vector<std::size_t>& volumeOf) {
    std::vector<Source> sources;
    for (std::size_t i = 0; i < clouds.size(); ++i) {
        const auto same = std::ranges::find_if(
            sources, [&](const Source& source) { return sourceOf(*source.cloud) == sourceOf(clouds[i]); });
        volumeOf.push_back(static_cast<std::size_t>(same - sources.begin()));
        if (same == sources.end()) sources.push_back({&clouds[i], i, {}, {}, {}, {}, 0.0, {}});
    }
    return sources;
}

/// Drops the fields that no source asks for.
void dropOthers(KnownFields& known, const std::vector<Source>& sources) {
    std::erase_if(known.fields, [&](const KnownField& field) {
        return std::ranges::none_of(sources, [&](const Source& source) { return isKnown(field, source); });
    });
}

/// The fields that were loaded, with what is told of each; in bricks where nothing is said of filled voxels.
KnownFields fieldsOf(const std::vector<Source>& sources, const std::vector<vdb::ColumnSums>& sums,
                     const std::vector<FilledVoxels>& filled) {
    KnownFields known;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Source& source = sources[i];
        known.fields.push_back({*source.cloud, source.index, source.budget, source.loaded, source.volume, sums[i],
                                filled.empty() ? FilledVoxels() : filled[i], filled.empty()});
    }
    return known;
}

}  // namespace

KnownFields knownIn(const KnownFields& known, const scene::Scene& scene) {
    std::vector<std::size_t> volumeOf;
    KnownFields shown = known;
    dropOthers(shown, differentSources(scene.clouds, volumeOf));
    return shown;
}

std::shared_ptr<const vdb::Volume> withoutValues(const vdb::Volume& volume) {
    return std::make_shared<const vdb::Volume>(
        vdb::Volume{volume.size, {}, volume.maximum, volume.toWorld, volume.name});
}

std::vector<vdb::PlacedVolume> CloudVolumes::placed() const {
    std::vector<vdb::PlacedVolume> result;
    for (const Cloud& cloud : clouds) {
        vdb::PlacedVolume& placed = result.emplace_back(*volumes[cloud.volume], cloud.toWorld);
        if (isSparse()) placed.bricks = &bricks[cloud.volume];
    }
    return result;
}

CloudVolumes loadClouds(const scene::Scene& scene, const Report& report, const Check& check, FieldStorage storage,
                        KnownFields* known) {
    constexpr double treesPerBudget = 8.0;
    const double budget = scene.preparation.memoryBudget;
    const vdb::ReadLimits limits{check, treesPerBudget * budget};
    std::vector<std::size_t> volumeOf;
    std::vector<Source> sources = differentSources(scene.clouds, volumeOf);
    const bool sparse = storage == FieldStorage::asWanted && wantsBricks(scene.preparation, sources, limits);
    if (sparse) {
        for (Source& source : sources)
            if (source.isFile()) {
                readBricks(source, report, limits);
                if (known != nullptr) recognise(source, *known);
            } else {
                fill(source, budget, report, limits, known, true);
            }
    } else {
        if (known != nullptr) dropOthers(*known, sources);
        loadAll(sources, budget, report, limits, known);
    }
    CloudVolumes result;
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const std::string where = keysOf(scene, i) + ".transform";
        result.clouds.push_back({volumeOf[i], sources[volumeOf[i]].placeUnder(scene.clouds[i].transform, where), {}});
    }
    for (Source& source : sources) {
        for (const std::string& warning : source.loaded.warnings) {
            const bool alone = scene.clouds.size() == 1;
            std::string text = alone ? warning : keysOf(scene, source.index) + ": " + warning;
            // parts of a file say the same
            if (std::ranges::find(result.warnings, text) == result.warnings.end())
                result.warnings.push_back(std::move(text));
        }
        result.volumes.push_back(source.volume);
        if (sparse) result.bricks.push_back(std::move(source.bricks));
    }
    if (sparse) layBricks(scene, result, check);
    std::vector<vdb::ColumnSums> sums;
    for (std::size_t i = 0; i < sources.size(); ++i)
        sums.push_back(sparse            ? vdb::columnSums(result.bricks[i])
                       : sources[i].sums ? *sources[i].sums
                                         : vdb::columnSums(*result.volumes[i], check));
    if (known != nullptr && !sparse)
        for (const Source& source : sources)
            result.filled.push_back(source.filled ? *source.filled : filledVoxels(*source.volume));
    if (known != nullptr) *known = fieldsOf(sources, sums, result.filled);
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        CloudVolumes::Cloud& cloud = result.clouds[i];
        const double extinction = scene.clouds[i].extinction * scene.clouds[i].densityScale;
        cloud.thickness = vdb::opticalThickness(sums[cloud.volume], cloud.toWorld, extinction);
    }
    for (const scene::Cloud& cloud : scene.clouds)
        if (!cloud.held.empty())
            result.warnings.push_back(cloud.held + " does not exist: " + cloud.vdb.string() + " stands for it");
    for (std::string& warning : warningsOf(summarise(scene, result))) result.warnings.push_back(std::move(warning));
    return result;
}

}  // namespace lumulus
