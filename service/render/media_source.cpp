#include "service/render/media_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "scene/alternatives.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"

namespace lumulus::service {

namespace {

const std::string section = "fog.media.";

std::string pathOf(const MediumEdit& edit) {
    return fmt::format("{}{}.", section, edit.medium);
}

/// The place that a message names, as "media[0].top"; empty where it is in none of these media.
std::string placeIn(const std::string& message, std::span<const MediumEdit> edits) {
    for (std::size_t i = 0; i < edits.size(); ++i) {
        const std::string path = fmt::format("({}", pathOf(edits[i]));
        const std::size_t found = message.find(path);
        if (found == std::string::npos) continue;
        const std::size_t begin = found + path.size();
        const std::size_t end = message.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", begin);
        return fmt::format("media[{}].{}", i, message.substr(begin, end == std::string::npos ? end : end - begin));
    }
    return {};
}

}  // namespace

MediaKeys changedKeys(MediaKeys keys, std::span<const MediumEdit> edits) {
    for (const MediumEdit& edit : edits) {
        const std::string path = pathOf(edit);
        if (edit.original) std::erase_if(keys, [&](const auto& key) { return key.first.starts_with(path); });
        for (const auto& [name, value] : edit.keys)
            for (const std::string& other : scene::alternativesOf(path + name, section + name)) keys.erase(other);
        for (const auto& [name, value] : edit.keys) keys[path + name] = value;
    }
    return keys;
}

std::vector<std::string> overridesOf(const MediaKeys& keys) {
    std::vector<std::string> overrides;
    for (const auto& [path, value] : keys) overrides.push_back(path + "=" + value);
    return overrides;
}

std::vector<scene::FogMedium> mediaWith(const LoadScene& load, const RenderConfig& config, const MediaKeys& keys,
                                        bool lit) {
    std::vector<std::string> overrides = load.overrides;
    overrides.insert(overrides.end(), {"cloud=[]", "field=[]"});
    std::ranges::copy(overridesOf(keys), std::back_inserter(overrides));
    const std::array<std::filesystem::path, 2> folders{config.scenes, config.uploads};
    const std::string name = load.name.empty() ? "inline" : load.name;
    const scene::Scene scene =
        scene::parseScene(load.toml, (config.scenes / name).string(), overrides, load.quality, folders);
    if (lit) scene::requireBoundedFog(scene);
    return scene.fog.media;
}

Failure failureOf(const InputError& error, std::span<const MediumEdit> edits) {
    std::string message = error.what();
    const std::string set = "--set ";
    for (std::size_t at = message.find(set); at != std::string::npos; at = message.find(set, at))
        message.erase(at, set.size());
    const std::string place = placeIn(message, edits);
    return {"bad_request", message, place.empty() ? "media" : place};
}

}  // namespace lumulus::service
