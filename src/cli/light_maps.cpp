#include "cli/light_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "cli/output.h"

namespace lumulus::cli {

namespace {

using photon::GenerationRange;

/// The part of this number, counted from 1, of all generations in nearly equal parts.
GenerationRange partOf(std::uint64_t number, std::uint64_t parts, std::uint64_t available) {
    if (number < 1 || number > parts || parts > available)
        throw InputError(
            fmt::format("there is no part {} of {} of the scene's {} generations", number, parts, available),
            "--generations", "parts are counted from 1, and each has a generation at least");
    const std::uint64_t first = (number - 1) * available / parts;
    return {first, number * available / parts - first};
}

/// "FIRST-LAST" or one number, or "PART/PARTS", of the `available` generations of a scene.
GenerationRange rangeOf(const std::string& text, int available) {
    const char* const end = text.data() + text.size();
    std::uint64_t first = 0, last = 0;
    auto read = std::from_chars(text.data(), end, first);
    last = first;
    const char between = read.ec == std::errc() && read.ptr != end ? *read.ptr : ' ';
    if (between == '-' || between == '/') read = std::from_chars(read.ptr + 1, end, last);
    const bool whole = read.ec == std::errc() && read.ptr == end;
    if (whole && between == '/') return partOf(first, last, static_cast<std::uint64_t>(std::max(0, available)));
    if (!whole || last < first)
        throw InputError(fmt::format("\"{}\" is no range of generations", text), "--generations",
                         "write FIRST-LAST, such as 0-9, or PART/PARTS, such as 1/4");
    if (last >= static_cast<std::uint64_t>(available))
        throw InputError(
            fmt::format("the scene has generations 0 to {}, and {} is not one of them", available - 1, last),
            "--generations", "ask for fewer, or raise photon_map.generations in all parts");
    return {first, last - first + 1};
}

std::string namesOf(const std::vector<std::filesystem::path>& paths) {
    return paths.size() == 1 ? paths.front().string()
                             : fmt::format("{} and {} more", paths.front().string(), paths.size() - 1);
}

}  // namespace

LightMaps::LightMaps(const LightMapOptions& options, scene::Scene& scene) : options_(options) {
    if (!options.generations.empty()) {
        range_ = rangeOf(options.generations, scene.photonMap.generations);
        scene.photonMap.firstGeneration += static_cast<std::int64_t>(range_->first);
    }
    if (!options.in.empty()) map_ = map_file::readMaps(options.in);
}

std::uint64_t LightMaps::wanted(const Renderer& renderer) const {
    const auto all = static_cast<std::uint64_t>(renderer.generationsWanted());
    return range_ && all > 0 ? range_->count : all;
}

std::uint64_t LightMaps::load(Renderer& renderer, const scene::Scene& scene) {
    if (!map_) return 0;
    if (map_->fingerprint != renderer.lightFingerprint(scene))
        throw InputError("the photon map is of another scene, light, seed or version", namesOf(options_.in),
                         "render the scene that it was traced for, with the same settings");
    const std::vector<GenerationRange>& there = map_->sums.generations;
    if (there.empty()) return 0;
    const auto first = static_cast<std::uint64_t>(scene.photonMap.firstGeneration);
    const std::uint64_t end = first + wanted(renderer);
    if (there.back().end() > end || there.front().first < first)
        throw InputError(fmt::format("the maps have generations {}, and the picture those from {} to {}",
                                     map_file::inWords(there), first, end - 1),
                         namesOf(options_.in), "leave out what is beyond");
    if (there.size() > 1 || there.front().first != first) {
        const std::uint64_t missing = there.front().first != first ? first : there.front().end();
        const std::uint64_t next = there.front().first != first ? there.front().first : there[1].first;
        throw InputError(fmt::format("the maps have generations {}: {} {} missing", map_file::inWords(there),
                                     map_file::inWords(std::vector{GenerationRange{missing, next - missing}}),
                                     next - missing == 1 ? "is" : "are"),
                         namesOf(options_.in), "give their maps too");
    }
    renderer.goOnFrom(map_->sums);
    return there.front().count;
}

void LightMaps::save(Renderer& renderer, const scene::Scene& scene) const {
    if (options_.out.empty()) return;
    map_file::writeMap(options_.out, {renderer.lightFingerprint(scene), renderer.tracedSums()});
}

void runMerge(const MergeOptions& options) {
    checkPlaces({options.output});
    const map_file::MapFile map = map_file::readMaps(options.maps);
    const std::vector<GenerationRange>& generations = map.sums.generations;
    map_file::writeMap(options.output, map);
    if (generations.size() > 1)
        logWarning(fmt::format("the map has generations {}: a picture needs those between too",
                               map_file::inWords(generations)));
    else if (!options.quiet)
        logNote(fmt::format("generations {}, {} photons", map_file::inWords(generations),
                            map.sums.generationsTraced() * map.sums.photonsEach));
}

}  // namespace lumulus::cli
