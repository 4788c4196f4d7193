#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/quality.h"
#include "scene/scene.h"

namespace lumulus::scene {

/// Reads a scene file, standard input for "-". A file of clouds (OpenVDB, NanoVDB) stands for a scene of it alone with
/// every key at its default. `overrides` are the strings of --set (`section.key=value`). A preset changes only keys
/// that the file leaves out. Errors: InputError that names file, line and key.
/// Keys of [animate] have their values at `frame`.
Scene loadScene(const std::filesystem::path& path, std::span<const std::string> overrides = {},
                std::optional<Quality> quality = std::nullopt, double frame = 0.0);

/// Reads a scene from text. `sourceName` stands for the file in messages, and relative paths start in its folder. If
/// `folders` are given, files outside of them (symbolic links followed) are refused like files that do not exist.
/// Errors: those of loadScene.
Scene parseScene(std::string_view toml, const std::string& sourceName, std::span<const std::string> overrides = {},
                 std::optional<Quality> quality = std::nullopt, std::span<const std::filesystem::path> folders = {},
                 double frame = 0.0);

/// The text that loadScene() would read, and what messages call it: to make scenes of several frames from what is read
/// once.
struct SceneText {
    std::string toml, source;
};
SceneText sceneText(const std::filesystem::path& path);

/// The name of standard input in place of a scene file.
inline constexpr const char* standardInput = "-";

/// Reads the text of a scene file, standard input for "-". Errors: InputError if it cannot be read, is larger than
/// 1 MiB or of another kind (OpenVDB, an archive, a picture).
std::string readSceneText(const std::filesystem::path& path);

}  // namespace lumulus::scene
