#pragma once

#include <algorithm>
#include <vector>

#include "frame/frame.h"
#include "gpu/commands.h"

namespace lumulus::test {

/// A frame under a sky of that radiance, with drawn pixels in the rectangle `place` and the sun's disc before it.
inline void fillFrame(gpu::Context& context, frame::Frame& frame, const glm::vec3& sky,
                      const std::vector<shared::Pixel>& drawn, const Tile& place,
                      const std::vector<shared::SunPixel>& sun) {
    gpu::Commands commands(context);
    const gpu::Buffer pixels(context, "pixels", drawn.size() * static_cast<std::size_t>(shared::PIXEL_TEXELS),
                             VK_FORMAT_R32G32B32A32_SFLOAT, gpu::Memory::host);
    std::ranges::copy(drawn, pixels.mapped<shared::Pixel>().begin());
    commands.begin();
    frame.recordBackground(commands, sky, place);
    commands.barrier("frame background");
    frame.recordBand(commands, pixels, place);
    commands.barrier("frame band");
    if (!sun.empty()) frame.recordSun(commands, sun);
    commands.submit();
    commands.wait();
}

}  // namespace lumulus::test
