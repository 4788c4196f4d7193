#include "scene/document.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "scene/arrays.h"
#include "scene/quality.h"
#include "scene/schema.h"

namespace lumulus::scene {
namespace {

constexpr std::string_view introduction = R"(# The scene file

Made by `lumulus info --scene-format > docs/scene-format.md`; a test compares the two. Do not edit by hand.

A scene is a [TOML](https://toml.io) file of at most 1 MiB. Every key has a default: an empty file renders the
procedural cumulus before an atmosphere. Unknown keys, wrong types, values out of range and parameters that the
chosen phase function does not have are errors that name the key and the line. Numbers may be written as integers; `1e6`
may stand for a whole number. NaN and infinity are refused everywhere.

- Units: metres, degrees, W/m² and W/(m² sr) per channel of linear Rec. 709. Right-handed, +Y is up.
- Paths are relative to the scene file.
- `[[cloud]]` stands once for each cloud, at most 256 times. Where clouds overlap, their extinctions add up. A file
  without `[[cloud]]`, `[[field]]` and `[[mesh]]` has one, `cloud = []` is a scene without any.
- `[[field]]` stands once for each field of procedural clouds (docs/fields.md).
- `[[fog.media]]` stands once for each medium; without one there is no fog. Keys that a medium's kind does not have are
  errors.
- `[[surface]]` stands once for each opaque surface, for `lumulus reference` only: `render` refuses them.
- `[[lamp]]` stands once for each lamp (docs/lamps.md).
- `[[mesh]]` stands once for each triangle mesh (docs/meshes.md).
- `--set section.key=value` overrides a key, `--set cloud.0.extinction=0.2` one of the first cloud,
  `--set cloud.veil.extinction=0.2` one of the cloud whose `name` is `veil`, `--set fog.media.0.visibility=500` one of
  the first medium. The index after the last one adds an entry. The value is TOML, or else a bare string:
  `--set draw.mode=march`. An override of one of two keys that exclude each other (`sun.azimuth`, `sun.direction_to`;
  `cloud.0.vdb`, `cloud.0.procedural`) takes the file's other one out; one of `cloud.0.phase.model` or of the `kind` of
  a medium, surface or lamp takes out the parameters that it does not have.
- `--quality` stands below the file: it changes only what the scene leaves out. Where a cloud has flat voxels, it asks
  for three times the photons, at most 6,000,000, and for at least 8 bands and at most 6° (docs/experiments/flat-voxels.md).
- `[animate]` has the values of keys over the frames of `lumulus render --frames` (docs/sequences.md).
)";

std::string qualityTable() {
    constexpr std::array<std::pair<const char*, Quality>, 3> presets = {
        {{"draft", Quality::draft}, {"interactive", Quality::interactive}, {"final", Quality::final}}};
    std::string text = "\n| quality | photons | generations | bands | forward_cut |\n|---|---|---|---|---|\n";
    for (const auto& [name, quality] : presets) {
        Scene scene;
        applyQuality(scene, quality);
        const PhotonMap& map = scene.photonMap;
        text += fmt::format("| `{}` | {} | {} | {} | {} |\n", name, map.photons, map.generations, map.bands,
                            map.forwardCut);
    }
    return text;
}

std::string heading(std::string_view section) {
    if (const ArraySection* array = arrayOf(section); array != nullptr && array->name == section)
        return fmt::format("[[{}]]", section);
    if (const std::size_t dot = section.rfind('.'); dot != std::string_view::npos)
        return fmt::format("[{}] (or `{} = {{ … }}` in [{}])", section, section.substr(dot + 1),
                           section.substr(0, dot));
    return fmt::format("[{}]", section);
}

std::string typeAndRange(const Key& key) {
    switch (key.type) {
        case Type::choice:
            return fmt::format("`\"{}\"`", fmt::join(key.choices, "\"`, `\""));
        case Type::number:
        case Type::integer:
        case Type::rgb:
            return typeText(key) + ", " + key.range.text();
        default:
            return typeText(key);
    }
}

std::string fallbackCell(const Key& key) {
    if (key.fallback.starts_with('(')) return std::string(key.fallback.substr(1, key.fallback.size() - 2));
    return fmt::format("`{}`", key.fallback);
}

}  // namespace

std::string sceneFormatMarkdown() {
    std::string text = std::string(introduction) + qualityTable();
    std::string_view section;
    for (const Key& key : schema()) {
        const std::size_t dot = key.name.rfind('.');
        if (key.name.substr(0, dot) != section) {
            section = key.name.substr(0, dot);
            text +=
                fmt::format("\n## {}\n\n| key | value | default | meaning |\n|---|---|---|---|\n", heading(section));
        }
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.name.substr(dot + 1), typeAndRange(key), fallbackCell(key),
                            key.documentation);
    }
    return text;
}

}  // namespace lumulus::scene
