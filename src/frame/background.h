#pragma once

#include <span>
#include <vector>

#include "base/image.h"
#include "shared/frame.h"
#include "view/view.h"

namespace lumulus::frame {

/// All layers that a picture has, of that radiance, nothing in the way. A is 1: the background is part of R, G, B.
LayeredImage emptyFrame(const Tile& tile, const glm::dvec3& radiance = glm::dvec3(0.0));

/// Adds the sun's disc to layers R, G and B, as seen through what the pixels' transmittance says.
void addSun(LayeredImage& image, const std::vector<shared::SunPixel>& pixels);

/// Leaves the background out of a picture: R, G, B and A become those of the cloud alone.
void leaveOutBackground(LayeredImage& image);

/// Spreads a rectangle of pixels over the layers of an image; `place` is where it lies in it.
void copyPixels(std::span<const shared::Pixel> pixels, LayeredImage& image, const Tile& place);

}  // namespace lumulus::frame
