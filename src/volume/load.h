#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "base/progress.h"
#include "scene/scene.h"
#include "vdb/optical_thickness.h"
#include "vdb/placed_volume.h"
#include "vdb/sparse_volume.h"
#include "view/filled_voxels.h"

namespace lumulus {

struct KnownFields;

/// The density fields of a scene's clouds. Clouds of the same source (file and grid, or kind, resolution and seed)
/// share one field, which is loaded once; each cloud has a place of its own.
struct CloudVolumes {
    /// Which field a cloud shows, and where.
    struct Cloud {
        std::size_t volume = 0;  ///< index into `volumes`
        vdb::Affine toWorld;     ///< voxel coordinates → metres, with the scene's `transform`
        vdb::OpticalThickness thickness;
    };

    /// At their own places, without the scene's `transform`. One that another scene shows too is the same.
    std::vector<std::shared_ptr<const vdb::Volume>> volumes;
    std::vector<FilledVoxels> filled;       ///< as many, where others may be known, else none
    std::vector<vdb::SparseVolume> bricks;  ///< as many, laid out, where the fields are in bricks, else none
    std::vector<Cloud> clouds;              ///< as many as the scene has, in its order
    std::vector<std::string> warnings;      ///< what a person should know, one line each

    bool isSparse() const { return !bricks.empty(); }
    /// The clouds one by one. They point into `volumes` and `bricks`.
    std::vector<vdb::PlacedVolume> placed() const;
};

/// How fields may be stored: as voxels of the whole box, or as the scene's `preparation.storage` has it.
enum class FieldStorage { dense, asWanted };

/// Loads or makes the clouds of a scene. All fields together keep to `preparation.memory_budget` as far as files go:
/// procedural clouds have the resolution that the scene asks for. Where the rest of the budget is too small, files that
/// need no more than an even share of it are loaded in full, and the others are averaged to an even share of what is
/// left. Trees take eight times the budget at most while they are read. Errors: InputError for bad grids, a
/// transform that is singular or a budget below one voxel; Error where interrupted, or what `report` and `check` throw.
/// `check` is asked on any thread, by several at once.
///
/// Fields in bricks are not averaged: what does not fit the budget (pool, indices, majorants) has coarser levels where
/// the scene's camera sees voxels smallest. Values of files come later, leaf by leaf (vdb::fillSlots).
///
/// Fields that are `known` from another scene are taken from there: they are what loading gives, as long as files
/// stay as they are. It has those of this scene then, and drops others before any is loaded. Known fields without
/// values stay so.
CloudVolumes loadClouds(const scene::Scene& scene, const Report& report = noReport,
                        const Check& check = stopIfInterrupted, FieldStorage storage = FieldStorage::dense,
                        KnownFields* known = nullptr);

}  // namespace lumulus
