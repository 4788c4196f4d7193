#pragma once

#include <span>

#include "base/image.h"
#include "draw/camera.h"
#include "draw/picture_view.h"
#include "scene/scene.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// All layers that a picture has, black, nothing in the way.
LayeredImage emptyFrame(const Tile& tile);

/// The part `tile` of the picture without a cloud: sky, the sun's disc, and the layers that every picture has.
LayeredImage skyImage(const Camera& camera, const Tile& tile, const scene::Sun& sun, const scene::Sky& sky);

/// Spreads a band of pixels, rows from `firstRow` of the image, over its layers.
void copyPixels(std::span<const shared::Pixel> pixels, LayeredImage& image, int firstRow, int rows);

}  // namespace lumulus::draw
