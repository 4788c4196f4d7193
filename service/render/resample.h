#pragma once

#include "base/image.h"
#include "view/view.h"

namespace lumulus::service {

/// The view with its sides divided by `reduction`, one ray a pixel and coarse light. Its tile holds that of the view.
View reducedView(const View& view, int reduction);

/// Enlarges a picture of reducedView(view) to the pixels of `view`, with bilinear interpolation. Depths, which must not
/// be mixed, take the nearest pixel.
LayeredImage enlarged(const LayeredImage& image, const View& view, const View& reduced);

}  // namespace lumulus::service
