#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

/// Which grid of a file is the cloud's density (inside vdb/ only).
namespace lumulus::vdb {

/// What is known of a grid before it is taken.
struct GridLabel {
    std::string name;
    std::string type;                                        ///< of its values, as in GridInfo
    bool isScalar = false;                                   ///< float, half or double
    bool levelSet = false;                                   ///< of the class level set: distances to a surface
    std::function<bool()> hasContent = [] { return true; };  ///< whether any active value is above 0
};

struct GridChoice {
    std::size_t index = 0;
    std::vector<std::string> warnings;  ///< one line each
};

/// Chooses a grid. `wanted` is a name in any case, spaces around it ignored, or empty; `density[1]` is the second of
/// the grids of that name. Without a name the names decide (nameRank), an empty grid only where no other may be taken,
/// and temperatures, velocities and the like only where there is no other scalar grid. `file` stands in messages for
/// the file, `key` for the key that names the grid. Errors: InputError where there is no such grid, or none of scalars
/// that is no level set.
GridChoice chooseGrid(std::span<const GridLabel> grids, const std::string& wanted, const std::string& file,
                      const std::string& key);

}  // namespace lumulus::vdb
