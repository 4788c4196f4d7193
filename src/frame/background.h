#pragma once

#include <span>
#include <vector>

#include "base/image.h"
#include "scene/scene.h"
#include "shared/frame.h"
#include "sky/environment.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::frame {

/// All layers that a picture has, of that radiance, nothing in the way. A is 1: the background is part of R, G, B.
LayeredImage emptyFrame(const Tile& tile, const glm::dvec3& radiance = glm::dvec3(0.0));

/// The pixels of the part `tile` that see the sun's disc, but for those in the part `without`, with the radiance that
/// they have. `rays` along each side of a pixel meet the disc or not.
std::vector<shared::SunPixel> sunPixels(const Camera& camera, const Tile& tile, const scene::Sun& sun,
                                        const sky::Environment& environment, int rays, const Tile& without);

/// The part `tile` of the picture without a cloud: sky, the sun's disc, and the layers that every picture has. `rays`
/// along each side of a pixel meet the disc or not; it may be left out in a part, which is drawn later.
LayeredImage skyImage(const Camera& camera, const Tile& tile, const scene::Sun& sun,
                      const sky::Environment& environment, int rays = 1, const Tile& without = {0, 0, 0, 0});

/// Leaves the background out of a picture: R, G, B and A become those of the cloud alone.
void leaveOutBackground(LayeredImage& image);

/// Spreads a rectangle of pixels over the layers of an image; `place` is where it lies in it.
void copyPixels(std::span<const shared::Pixel> pixels, LayeredImage& image, const Tile& place);

}  // namespace lumulus::frame
