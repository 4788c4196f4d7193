#pragma once

#include <vector>

#include "base/progress.h"
#include "volume/load.h"
#include "volume/source.h"

/// Fields in bricks (inside volume/ only).
namespace lumulus {

/// Whether fields are to be in bricks: where the scene says so, or by their structure where it leaves that open.
/// Errors: those of reading the structure of files.
bool wantsBricks(const scene::Preparation& preparation, const std::vector<Source>& sources,
                 const vdb::ReadLimits& limits);

/// Reads the leaves of a file. `loaded` gets all but values.
void readBricks(Source& source, const Report& report, const vdb::ReadLimits& limits);

/// Lays out the bricks of all fields, within the budget. Warns of what has a coarse level. Errors: InputError where the
/// coarsest levels need more than the budget; what `check` throws.
void layBricks(const scene::Scene& scene, CloudVolumes& volumes, const Check& check);

}  // namespace lumulus
