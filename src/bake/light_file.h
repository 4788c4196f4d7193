#pragma once

#include <filesystem>
#include <string>

#include "bake/light_grid.h"
#include "scene/scene.h"
#include "vdb/write_vectors.h"

namespace lumulus::bake {

/// Where a light file and what belongs to it are written.
struct LightPlaces {
    std::filesystem::path vdb;
    std::filesystem::path conventions;  ///< JSON
    std::filesystem::path nano;         ///< empty: none
};

/// light.vdb has light.json beside it, and with `nano` light.nvdb.
LightPlaces placesOf(const std::filesystem::path& vdb, bool nano);

/// The grids of docs/bake.md.
vdb::VectorGrids gridsOf(const LightGrid& grid);

/// What a program needs to know to read them, as JSON.
std::string conventionsOf(const LightGrid& grid, const scene::Scene& scene, const std::filesystem::path& vdb);

/// Writes all files, each of them whole or not at all. Errors: those of writing files; what `check` throws.
void writeLight(const LightPlaces& places, const LightGrid& grid, const scene::Scene& scene, const Report& report,
                const Check& check);

}  // namespace lumulus::bake
