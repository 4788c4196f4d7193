#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "vdb/sparse_field.h"

/// What the values of a sparse field are, before they become a volume (inside vdb/ only).
namespace lumulus::vdb {

/// A value that is no density, at an index coordinate.
struct BadValue {
    glm::ivec3 at{0};
    float value = 0.0F;
};

/// The density in one block.
struct BlockContent {
    IndexBox occupied;         ///< around the values above 0; empty if there are none
    double mass = 0.0;         ///< sum of the values above 0, one for each voxel
    std::uint64_t voxels = 0;  ///< that hold them
};

struct Survey {
    std::vector<BlockContent> blocks;  ///< of each block of the field
    IndexBox occupied;                 ///< around all values above 0; empty if there are none
    double mass = 0.0;
    float maximum = 0.0F;                 ///< of finite values; 0 if none is above
    std::uint64_t notFinite = 0;          ///< voxels that are infinite or not a number …
    std::optional<BadValue> firstOfThem;  ///< … and the one with the lexicographically smallest coordinate
    std::uint64_t negatives = 0;          ///< voxels below 0 …
    std::optional<BadValue> lowest;       ///< … and the smallest value, at its lexicographically smallest coordinate
};

/// Visits every value once. Values that are not finite or negative count as 0 for mass and occupied box.
/// Errors: what `check` throws.
Survey surveyField(const SparseField& field, const Check& check);

/// Adds the survey of more blocks of a field, which come after those that there are.
void append(Survey& survey, Survey&& part);

/// Makes negative, infinite and undefined values 0.
void clampValues(SparseField& field);

/// The part of a field that is left out because it lies far from the rest and weighs next to nothing.
struct Apart {
    IndexBox kept;             ///< the box around the rest; the whole occupied box where nothing is left out
    glm::ivec3 at{0};          ///< a voxel that is left out
    std::uint64_t voxels = 0;  ///< left out
    double share = 0.0;        ///< of the mass
};

/// Finds what lies apart: at most a millionth of the mass, divided from the rest by an empty gap of 8 voxels or more
/// along an axis, and without which the box has at most half the volume.
Apart findApart(const Survey& survey);

}  // namespace lumulus::vdb
