#pragma once

#include <span>

#include "base/image.h"
#include "draw/camera.h"
#include "scene/scene.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// The picture without a cloud: sky, the sun's disc, and the layers that every picture has.
LayeredImage skyImage(const Camera& camera, const scene::Sun& sun, const scene::Sky& sky);

/// Spreads a band of pixels, rows from `firstRow`, over the layers of the picture.
void copyPixels(std::span<const shared::Pixel> pixels, LayeredImage& image, int firstRow, int rows);

}  // namespace lumulus::draw
