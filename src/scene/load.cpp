#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/file_kind.h"
#include "scene/read_value.h"
#include "scene/settings.h"
#include "scene/suggest.h"
#include "scene/validate.h"

namespace lumulus::scene {
namespace {

constexpr std::size_t maximumBytes = std::size_t{1} << 20;

/// What a scene is read from, as for parseScene.
struct Sources {
    std::string_view toml;
    const std::string& name;
    std::span<const std::string> overrides;
    std::optional<Quality> quality;
    std::span<const std::filesystem::path> folders;
    double frame = 0.0;
};

/// Reads a scene. `current` becomes the index of the override that is looked up, nothing before and after.
Scene readScene(const Sources& from, std::optional<std::size_t>& current) {
    Settings settings;
    settings.addFile(from.toml, from.name);
    double fps = Draft().fps;
    if (const toml::node* section = settings.animation()) {
        const Animation animation(*section, from.name, from.folders);
        settings.addAnimation(animation, from.frame);
        fps = animation.fps();
    }
    for (std::size_t i = 0; i < from.overrides.size(); ++i) {
        current = i;
        settings.addOverride(from.overrides[i]);
    }
    current.reset();

    Draft draft;
    draft.scene.source = from.name;
    draft.folder = std::filesystem::path(from.name).parent_path();
    draft.allowed = from.folders;
    draft.frame = from.frame;
    draft.fps = fps;
    draft.scene.fields.resize(settings.entries("field"));
    draft.scene.meshes.resize(settings.entries("mesh"));
    draft.scene.clouds.resize(
        settings.entries("cloud", draft.scene.fields.empty() && draft.scene.meshes.empty() ? 1 : 0));
    draft.scene.fog.media.resize(settings.entries("fog.media"));
    draft.scene.surfaces.resize(settings.entries("surface"));
    draft.scene.lamps.resize(settings.entries("lamp"));
    if (from.quality) applyQuality(draft.scene, *from.quality);
    for (const auto& [path, setting] : settings.all()) {
        draft.entry = setting.entry;
        setting.key->set(draft, readValue(*setting.node, *setting.key, setting.where));
    }
    return finishScene(std::move(draft), settings);
}

/// The paths that make a scene in place of an unknown one in the override number `wrong`: each is tried with the
/// override's value. Several only where they are equally near.
std::vector<std::string> workingPaths(Sources from, std::size_t wrong) {
    std::vector<std::string> overrides(from.overrides.begin(),
                                       from.overrides.begin() + static_cast<std::ptrdiff_t>(wrong) + 1);
    const std::string given = overrides.back();
    const std::size_t equals = given.find('=');
    Settings before;
    before.addFile(from.toml, from.name);
    for (std::size_t i = 0; i < wrong; ++i) before.addOverride(overrides[i]);
    std::vector<std::string> working, ofNewEntries;
    std::size_t nearest = 0;
    for (const LikelyPath& likely : pathsLike(given.substr(0, equals))) {
        if (working.size() + ofNewEntries.size() > 0 && likely.distance > nearest) break;
        overrides.back() = likely.path + given.substr(equals);
        from.overrides = overrides;
        std::optional<std::size_t> current;
        try {
            readScene(from, current);
        } catch (const InputError&) {
            continue;
        }
        nearest = likely.distance;
        const ArraySection* array = arrayOf(likely.path);
        (array != nullptr && before.entries(array->name) == 0 ? ofNewEntries : working).push_back(likely.path);
    }
    return working.empty() ? ofNewEntries : working;  // who mistypes a key of a cloud does not ask for a field
}

/// Refuses text that is too long or is no text of a scene.
void checkText(std::string_view text, const std::string& source) {
    if (isOpenVdb(text) || isNanoVdb(text))
        throw InputError("this is an OpenVDB file, not a scene", source, "name it in a scene: [[cloud]] vdb = …");
    if (const auto foreign = foreignFile(text))
        throw InputError(fmt::format("this is {}, not a scene", foreign->name), source, std::string(foreign->mend));
    if (text.size() > maximumBytes)
        throw InputError("the scene is larger than 1 MiB", source, "give a scene file (TOML)");
}

std::string readStandardInput() {
    std::string text(maximumBytes + 1, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), stdin));
    if (std::ferror(stdin) != 0)
        throw InputError("cannot read the scene: " + std::generic_category().message(errno), "standard input",
                         "give it a scene, or the name of a file");
    checkText(text, "standard input");
    return text;
}

bool hasCloudSuffix(const std::filesystem::path& path) {
    std::string suffix = path.extension().string();
    std::ranges::transform(suffix, suffix.begin(),
                           [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    return suffix == ".vdb" || suffix == ".nvdb";
}

/// Whether a file holds grids, or should by its name: what has such a name and no grids (an empty file, a pipe) is
/// refused by the loader, and not read as a scene.
bool isCloudFile(const std::filesystem::path& path) {
    if (hasCloudSuffix(path)) return true;
    const std::string start = fileStart(path);
    return isOpenVdb(start) || isNanoVdb(start);
}

/// The text of a scene that shows a file of clouds beside it.
std::string sceneOf(const std::filesystem::path& cloud) {
    std::string name;
    for (const char c : cloud.filename().string()) {
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
        if (c == '"' || c == '\\') name += '\\';
        name += control ? fmt::format("\\u{:04X}", static_cast<unsigned>(c)) : std::string(1, c);
    }
    return fmt::format("[[cloud]]\nvdb = \"{}\"\n", name);
}

}  // namespace

std::string readSceneText(const std::filesystem::path& path) {
    if (path == standardInput) return readStandardInput();
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
    checkText(text, path.string());
    return text;
}

SceneText sceneText(const std::filesystem::path& path) {
    if (path == standardInput) return {readStandardInput(), "standard input"};
    return {isCloudFile(path) ? sceneOf(path) : readSceneText(path), path.string()};
}

Scene loadScene(const std::filesystem::path& path, std::span<const std::string> overrides,
                std::optional<Quality> quality, double frame) {
    const SceneText text = sceneText(path);
    return parseScene(text.toml, text.source, overrides, quality, {}, frame);
}

Scene parseScene(std::string_view toml, const std::string& sourceName, std::span<const std::string> overrides,
                 std::optional<Quality> quality, std::span<const std::filesystem::path> folders, double frame) {
    const Sources from{toml, sourceName, overrides, quality, folders, frame};
    std::optional<std::size_t> current;
    try {
        return readScene(from, current);
    } catch (const UnknownKey& e) {
        if (!current) throw;
        const std::string& given = overrides[*current];
        if (pathsLike(given.substr(0, given.find('='))).empty()) throw;
        const std::vector<std::string> working = workingPaths(from, *current);
        const std::string mend = working.empty()
                                     ? "no key like it takes this value; lumulus info --scene-format lists all"
                                     : fmt::format("did you mean {}?", fmt::join(working, " or "));
        throw InputError(e.what_, e.where_, mend);
    }
}

}  // namespace lumulus::scene
