#pragma once

#include "base/image.h"
#include "draw/picture_view.h"

namespace lumulus::service {

/// The view with its sides divided by `reduction`, the part of it that holds the tile, one ray a pixel.
View reducedView(const View& view, int reduction);

/// A picture of reducedView(view) spread over the pixels of `view`: bilinear; depths, which must not be mixed, take the
/// nearest.
LayeredImage enlarged(const LayeredImage& image, const View& view, const View& reduced);

}  // namespace lumulus::service
