#include "draw/bands.h"

#include <algorithm>

#include "shared/draw.h"

namespace lumulus::draw {

int bandRows(const Tile& tile) {
    constexpr int bands = 6, fewestTiles = 2;
    const int tiles = (tile.height + bands * shared::TILE_EDGE - 1) / (bands * shared::TILE_EDGE);
    const int most = (1 << 18) / (tile.width * shared::TILE_EDGE);
    return std::max(fewestTiles, std::min(tiles, most)) * shared::TILE_EDGE;
}

std::vector<Band> allBands(const Tile& tile) {
    const int each = bandRows(tile);
    std::vector<Band> bands;
    for (int row = 0; row < tile.height; row += each) bands.push_back({row, std::min(each, tile.height - row)});
    return bands;
}

std::vector<Band> sampleBands(const Tile& tile) {
    constexpr int pixels = 40000, apart = 2 * shared::TILE_EDGE;
    const int bandCount = (tile.height + apart - 1) / apart;
    const int rows = std::clamp(pixels / (bandCount * tile.width), 1, apart);
    std::vector<Band> bands;
    for (int row = 0; row < tile.height; row += apart) bands.push_back({row, std::min(rows, tile.height - row)});
    return bands;
}

}  // namespace lumulus::draw
