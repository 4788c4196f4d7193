#include "draw/bands.h"

#include <algorithm>

#include "shared/draw.h"

namespace lumulus::draw {

int bandRows(const Tile& tile) {
    constexpr int bands = 16;
    const int tiles = (tile.height + bands * shared::TILE_EDGE - 1) / (bands * shared::TILE_EDGE);
    const int most = (1 << 18) / (tile.width * shared::TILE_EDGE);
    return std::max(1, std::min(tiles, most)) * shared::TILE_EDGE;
}

std::vector<Band> allBands(const Tile& tile) {
    const int each = bandRows(tile);
    std::vector<Band> bands;
    for (int row = 0; row < tile.height; row += each) bands.push_back({row, std::min(each, tile.height - row)});
    return bands;
}

std::vector<Band> sampleBands(const Tile& tile) {
    constexpr int pixels = 40000;
    const int tiles = (tile.height + shared::TILE_EDGE - 1) / shared::TILE_EDGE;
    const int rows = std::clamp(pixels / (tiles * tile.width), 1, shared::TILE_EDGE);
    std::vector<Band> bands;
    for (int row = 0; row < tile.height; row += shared::TILE_EDGE)
        bands.push_back({row, std::min(rows, tile.height - row)});
    return bands;
}

}  // namespace lumulus::draw
