#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "scene/scene.h"
#include "service/render/render_config.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// A scene that a client asked for, and a key that two requests share if and only if they may share photons.
struct SourcedScene {
    scene::Scene scene;
    std::string key;
    std::shared_ptr<const LoadScene> load;  ///< what asked for it, with the text that a name stands for
};

/// Finds the scene: names stay in the folder of scenes (links followed), clouds in it or among the uploads.
/// `owner` goes into the key of private scenes. Errors: RequestError `not_found`, `bad_request`.
SourcedScene sourceScene(const LoadScene& load, const RenderConfig& config, std::uint64_t owner);

/// The scene of SourcedScene::load at a frame. Errors: InputError; RequestError `not_found`.
scene::Scene sceneAt(const LoadScene& load, const RenderConfig& config, double frame);

/// The file of an upload, which does not expire meanwhile. Errors: RequestError `not_found` where there is none.
std::filesystem::path uploadedFile(const std::string& hash, const RenderConfig& config);

/// Lowers the memory budgets of a scene to what the service gives. Errors: InputError for what exceeds other limits.
void applyLimits(scene::Scene& scene, const RenderLimits& limits);

/// Whether a file, links followed, lies in a folder.
bool liesIn(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace lumulus::service
