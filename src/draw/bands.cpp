#include "draw/bands.h"

#include <algorithm>

#include "shared/draw.h"

namespace lumulus::draw {

int bandRows(const Camera& camera) {
    constexpr int bands = 32;
    const int tiles = (camera.height + bands * shared::TILE_EDGE - 1) / (bands * shared::TILE_EDGE);
    const int most = (1 << 18) / (camera.width * shared::TILE_EDGE);
    return std::max(1, std::min(tiles, most)) * shared::TILE_EDGE;
}

std::vector<Band> allBands(const Camera& camera) {
    const int each = bandRows(camera);
    std::vector<Band> bands;
    for (int row = 0; row < camera.height; row += each) bands.push_back({row, std::min(each, camera.height - row)});
    return bands;
}

std::vector<Band> sampleBands(const Camera& camera) {
    constexpr int pixels = 40000;
    const int tiles = (camera.height + shared::TILE_EDGE - 1) / shared::TILE_EDGE;
    const int rows = std::clamp(pixels / (tiles * camera.width), 1, shared::TILE_EDGE);
    std::vector<Band> bands;
    for (int row = 0; row < camera.height; row += shared::TILE_EDGE)
        bands.push_back({row, std::min(rows, camera.height - row)});
    return bands;
}

}  // namespace lumulus::draw
