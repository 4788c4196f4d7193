#pragma once

#include <string>
#include <string_view>

/// What the name of a grid tells of its content (inside vdb/ only).
namespace lumulus::vdb {

/// The name without the spaces around it, in lower case (ASCII).
std::string plainName(std::string_view name);

/// How much the name is that of a cloud's density: the smaller the better. "density" has 0; then come smoke, cloud,
/// extinction, lwc, qc and the like, names that contain such a word, and names that say nothing. The names of other
/// quantities, as temperature, flame and velocity, have `otherQuantity`.
int nameRank(std::string_view name);

inline constexpr int otherQuantity = 1000;

}  // namespace lumulus::vdb
