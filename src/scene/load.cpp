#include "scene/load.h"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "base/error.h"
#include "scene/read_value.h"
#include "scene/settings.h"
#include "scene/validate.h"

namespace lumulus::scene {
namespace {

constexpr std::size_t maximumBytes = std::size_t{1} << 20;

}  // namespace

std::string readSceneText(const std::filesystem::path& path) {
    std::error_code ec;
    if (std::filesystem::is_directory(path, ec)) {
        throw InputError("the scene is a folder", path.string(), "give a scene file");
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError("cannot read the file: " + std::generic_category().message(errno), path.string(),
                         "give a file that exists and may be read");
    }
    std::string text(maximumBytes + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (file.bad()) throw InputError("cannot read the scene", path.string(), "check the disk");
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (text.size() > maximumBytes) {
        throw InputError("the scene is larger than 1 MiB", path.string(), "give a scene file (TOML)");
    }
    return text;
}

Scene loadScene(const std::filesystem::path& path, std::span<const std::string> overrides,
                std::optional<Quality> quality) {
    return parseScene(readSceneText(path), path.string(), overrides, quality);
}

Scene parseScene(std::string_view toml, const std::string& sourceName, std::span<const std::string> overrides,
                 std::optional<Quality> quality, std::span<const std::filesystem::path> folders) {
    Settings settings;
    settings.addFile(toml, sourceName);
    for (const std::string& text : overrides) settings.addOverride(text);

    Draft draft;
    draft.scene.source = sourceName;
    draft.folder = std::filesystem::path(sourceName).parent_path();
    draft.allowed = folders;
    draft.scene.clouds.resize(settings.entries("cloud"));
    draft.scene.fog.media.resize(settings.entries("fog.media"));
    draft.scene.surfaces.resize(settings.entries("surface"));
    if (quality) applyQuality(draft.scene, *quality);
    for (const auto& [path, setting] : settings.all()) {
        draft.entry = setting.entry;
        setting.key->set(draft, readValue(*setting.node, *setting.key, setting.where));
    }
    return finishScene(std::move(draft), settings);
}

}  // namespace lumulus::scene
