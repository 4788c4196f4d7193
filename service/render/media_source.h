#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/fog.h"
#include "service/render/render_config.h"
#include "service/values/requests.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Keys of fog media that differ from the scene's file, by path as of --set ("fog.media.0.g"), with values in TOML.
using MediaKeys = std::map<std::string, std::string>;

/// What keys become by changes. A key takes those out that exclude it and that were changed before.
MediaKeys changedKeys(MediaKeys keys, std::span<const MediumEdit> edits);

/// The media of a scene's text with such keys, by the checks of scene files; where `lit`, also those of fog in the
/// light of a sun or a sky. No file of clouds is looked for. Errors: InputError.
std::vector<scene::FogMedium> mediaWith(const LoadScene& load, const RenderConfig& config, const MediaKeys& keys,
                                        bool lit);

/// "fog.media.0.g=0.8" of each key.
std::vector<std::string> overridesOf(const MediaKeys& keys);

/// What is wrong with changes, in the words of the scene's checks, and the field that is to blame: "media[0].top".
Failure failureOf(const InputError& error, std::span<const MediumEdit> edits);

}  // namespace lumulus::service
