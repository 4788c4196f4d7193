#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shared/draw.h"
#include "view/camera.h"

namespace lumulus::draw {

/// Which billboards each tile of pixels may show, nearest first.
struct TileLists {
    int across = 0, down = 0;
    std::vector<std::uint32_t> offsets;  ///< across·down + 1; tile t owns lists[offsets[t]] … lists[offsets[t+1])
    std::vector<std::uint32_t> lists;    ///< indices of billboards
};

/// `billboards` in the order in which they are blended, centres relative to the eye. Never leaves one out that a pixel
/// of the tile would meet; parallel, and the same for any number of threads.
TileLists makeTileLists(const Camera& camera, const std::vector<shared::Billboard>& billboards);

}  // namespace lumulus::draw
