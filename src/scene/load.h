#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/quality.h"
#include "scene/scene.h"

namespace lumulus::scene {

/// Reads a scene file. `overrides` are the strings of --set (`section.key=value`). A preset changes only keys that the
/// file leaves out. Errors: InputError that names file, line and key.
Scene loadScene(const std::filesystem::path& path, std::span<const std::string> overrides = {},
                std::optional<Quality> quality = std::nullopt);

/// Reads a scene from text. `sourceName` stands for the file in messages, and relative paths start in its folder. If
/// `folders` are given, files outside of them (symbolic links followed) are refused like files that do not exist.
/// Errors: those of loadScene.
Scene parseScene(std::string_view toml, const std::string& sourceName, std::span<const std::string> overrides = {},
                 std::optional<Quality> quality = std::nullopt, std::span<const std::filesystem::path> folders = {});

/// Reads the text of a scene file. Errors: InputError if it cannot be read or is larger than 1 MiB.
std::string readSceneText(const std::filesystem::path& path);

}  // namespace lumulus::scene
