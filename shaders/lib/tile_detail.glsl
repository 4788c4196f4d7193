// How fine a picture of several clouds is in a tile of pixels: what is interpolated must not have smaller structure than what
// lies between its points. The includer declares `params` and the buffer tileDetail[].
#ifndef LUMULUS_LIB_TILE_DETAIL
#define LUMULUS_LIB_TILE_DETAIL

#include "shared/draw.h"

uint tileDetailAt(ivec2 pixel) {
    const ivec2 tile = min(pixel, params.view.size - 1) / TILE_EDGE;  // points may lie beyond the picture
    return tileDetail[tile.y * params.tilesAcross + tile.x];
}

/// Rays of a pixel along a side.
int raysAt(ivec2 pixel) { return int(tileDetailAt(pixel) >> DETAIL_RAYS_SHIFT); }

uint detailAt(ivec2 pixel) { return tileDetailAt(pixel) & 3u; }

/// The finest at the corners of a square of `spacing` pixels.
uint detailOf(ivec2 square, int spacing) {
    const ivec2 low = square * spacing, high = low + spacing;
    return max(max(detailAt(low), detailAt(ivec2(high.x, low.y))), max(detailAt(ivec2(low.x, high.y)), detailAt(high)));
}

#endif
