#pragma once

#include <string>

#include "service/net/config.h"
#include "service/protocol/requests.h"

namespace lumulus::service {

/// A scene that a client asked for, and a key that two requests share if and only if they may share photons.
struct SourcedScene {
    scene::Scene scene;
    std::string key;
};

/// Finds the scene: names stay in the folder of scenes (links followed), clouds in it or among the uploads.
/// `owner` goes into the key of private scenes. Errors: RequestError `not_found`, `bad_request`.
SourcedScene sourceScene(const LoadScene& load, const Config& config, std::uint64_t owner);

/// Whether a file, links followed, lies in a folder.
bool liesIn(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace lumulus::service
