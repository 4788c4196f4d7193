#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "light/map_file/map_file.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace lumulus::cli {

/// What `lumulus render` does with photon maps in files.
struct LightMapOptions {
    std::vector<std::filesystem::path> in;
    std::filesystem::path out;  ///< empty: none is written
    std::string generations;    ///< "FIRST-LAST" or "PART/PARTS" of those of the scene; empty: all

    bool used() const { return !in.empty() || !out.empty() || !generations.empty(); }
};

/// The generations of a scene that are to be in its map, and what of it is in files.
class LightMaps {
  public:
    /// Reads the files, and lets the scene begin with its first generation. Errors: InputError for what is wrong with
    /// the range or a file, before any work.
    LightMaps(const LightMapOptions& options, scene::Scene& scene);

    /// Gives the renderer what was in the files. Returns how many of its generations are there. Errors: InputError
    /// where it is of another scene, or has not the first ones of those that are wanted.
    std::uint64_t load(Renderer& renderer, const scene::Scene& scene);
    /// Generations that the map is to have, where the scene needs any.
    std::uint64_t wanted(const Renderer& renderer) const;
    /// Writes the map, where that is asked for. Errors: those of writeMap().
    void save(Renderer& renderer, const scene::Scene& scene) const;

  private:
    const LightMapOptions& options_;
    std::optional<map_file::MapFile> map_;
    std::optional<photon::GenerationRange> range_;
};

struct MergeOptions {
    std::vector<std::filesystem::path> maps;
    std::filesystem::path output;
    bool quiet = false;
};

/// Runs `lumulus merge`. Errors: InputError for maps that do not belong together.
void runMerge(const MergeOptions& options);

}  // namespace lumulus::cli
