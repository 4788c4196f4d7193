#include "python/scene_document.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "scene/fog_bounds.h"
#include "volume/far_parts.h"
#include "volume/place_clouds.h"

namespace lumulus::python {

SceneDocument::SceneDocument(scene::SceneText text, std::optional<scene::Quality> quality, double frame)
    : text_(std::move(text)), quality_(quality), frame_(frame), scene_(parse()) {}

scene::Scene SceneDocument::parse() const {
    scene::Scene scene = scene::parseScene(text_.toml, text_.source, overrides_, quality_, {}, frame_);
    for (const auto& [cloud, voxels] : voxels_)
        if (cloud < scene.clouds.size()) scene.clouds[cloud].voxels = voxels;
    return scene;
}

void SceneDocument::set(std::span<const std::string> overrides) {
    const std::vector<std::string> before = overrides_;
    overrides_.insert(overrides_.end(), overrides.begin(), overrides.end());
    try {
        scene_ = parse();
    } catch (...) {
        overrides_ = before;
        throw;
    }
}

void SceneDocument::setDensity(std::shared_ptr<const scene::Voxels> voxels, const std::string& cloud) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene_.clouds.size(); ++i) {
        names.push_back(scene::nameOf(scene_, i));
        if (cloud != names.back() && cloud != std::to_string(i)) continue;
        voxels_[i] = voxels;
        scene_.clouds[i].voxels = std::move(voxels);
        return;
    }
    throw InputError(fmt::format("the scene has no cloud \"{}\"", cloud), text_.source,
                     names.empty() ? "give it a [[cloud]]" : fmt::format("it has {}", fmt::join(names, ", ")));
}

scene::Scene SceneDocument::placed() const {
    scene::requireBoundedFog(scene_);
    return divideFarParts(placeClouds(scene_));
}

}  // namespace lumulus::python
