#pragma once

#include "view/view.h"

namespace lumulus::draw {

/// The part of `within` that a cloud may be seen in: what lies within `reach` [m] of its bounds. Everything where the
/// eye may be in or beside it and in panoramas; of no width and height where none of it can be seen.
Tile shownPart(const Camera& camera, const Bounds& cloud, double reach, const Tile& within);

}  // namespace lumulus::draw
