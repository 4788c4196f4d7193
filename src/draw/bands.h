#pragma once

#include <vector>

#include "view/view.h"

namespace lumulus::draw {

/// Rows of the picture, from a whole tile's first, that are drawn at once.
struct Band {
    int first = 0, rows = 0;
};

/// Rows of the largest band, whole tiles: few enough that progress and Ctrl-C do not wait long, and 2^18 pixels at
/// most.
int bandRows(const Tile& tile);

/// All rows, from the top.
std::vector<Band> allBands(const Tile& tile);

/// The first of every sixteen rows, as many of them as make about 40,000 pixels in all, at least one.
std::vector<Band> sampleBands(const Tile& tile);

}  // namespace lumulus::draw
