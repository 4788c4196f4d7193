#include "service/render/scene_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "scene/load.h"
#include "service/values/request_error.h"
#include "service/values/sha256.h"
#include "volume/place_clouds.h"

namespace lumulus::service {

namespace fs = std::filesystem;

namespace {

/// The text of a named scene, or the one that the client brought.
std::string textOf(const LoadScene& load, const RenderConfig& config) {
    if (load.name.empty()) return load.toml;
    const fs::path file = config.scenes / load.name;
    std::error_code ec;
    // one answer for what lies elsewhere and what is not there: names tell nothing about the machine
    if (!liesIn(file, config.scenes) || !fs::is_regular_file(file, ec))
        throw RequestError("not_found", "there is no scene of this name", "name");
    return scene::readSceneText(file);
}

}  // namespace

bool liesIn(const fs::path& file, const fs::path& folder) {
    std::error_code ec;
    const fs::path real = fs::weakly_canonical(file, ec);
    if (ec) return false;
    const fs::path base = fs::canonical(folder, ec);
    return !ec && std::ranges::mismatch(base, real).in1 == base.end();
}

void applyLimits(scene::Scene& scene, const RenderLimits& limits) {
    scene.preparation.memoryBudget = std::min(scene.preparation.memoryBudget, limits.sceneMemory);
    scene.photonMap.memoryBudget = std::min(scene.photonMap.memoryBudget, limits.sceneMemory);
    const auto each = static_cast<std::uint64_t>(scene.photonMap.photons) /
                      static_cast<std::uint64_t>(std::max(1, scene.photonMap.generations));
    if (each > limits.photonsPerGeneration)
        throw InputError(
            fmt::format("a generation would hold {} photons, more than {}", each, limits.photonsPerGeneration),
            "photon_map.photons", "ask for more generations or fewer photons");
    const auto pixels = static_cast<std::uint64_t>(scene.image.width) * static_cast<std::uint64_t>(scene.image.height);
    if (pixels > limits.requests.pixels)
        throw InputError(fmt::format("the picture has {} pixels, more than {}", pixels, limits.requests.pixels),
                         "image.width", "make it smaller");
}

fs::path uploadedFile(const std::string& hash, const RenderConfig& config) {
    const fs::path upload = config.uploads / (hash + ".vdb");
    std::error_code ec;
    if (!fs::is_regular_file(upload, ec))
        throw RequestError("not_found", "no such upload is here: send it first", "vdb");
    fs::last_write_time(upload, fs::file_time_type::clock::now(), ec);  // it is used, and does not expire
    return fs::absolute(upload);
}

scene::Scene sceneAt(const LoadScene& load, const RenderConfig& config, double frame) {
    std::vector<std::string> overrides = load.overrides;
    if (!load.vdb.empty()) overrides.push_back("cloud.0.vdb=\"" + uploadedFile(load.vdb, config).string() + "\"");
    const std::string name = load.name.empty() ? "inline" : load.name;
    const std::array<fs::path, 2> folders{config.scenes, config.uploads};
    scene::Scene scene =
        scene::parseScene(load.toml, (config.scenes / name).string(), overrides, load.quality, folders, frame);
    scene.source = name;
    applyLimits(scene, config.limits);
    return placeClouds(std::move(scene));
}

SourcedScene sourceScene(const LoadScene& load, const RenderConfig& config, std::uint64_t owner) {
    if (load.name.find('\0') != std::string::npos)
        throw RequestError("not_found", "there is no scene of this name", "name");
    try {
        LoadScene read = load;
        read.toml = textOf(load, config);
        SourcedScene found;
        found.scene = sceneAt(read, config, 0.0);
        std::string key = read.toml + '\0' + (load.quality ? std::to_string(static_cast<int>(*load.quality)) : "");
        for (const std::string& one : load.overrides) key += '\0' + one;
        if (!load.vdb.empty()) key += std::string(1, '\0') + "vdb " + load.vdb;
        if (load.isPrivate) key += std::string(1, '\0') + "private " + std::to_string(owner);
        found.key = sha256Hex(std::as_bytes(std::span(key)));
        found.load = std::make_shared<const LoadScene>(std::move(read));
        return found;
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what());
    }
}

}  // namespace lumulus::service
