// Pixels in buffers. On lavapipe loads are by vectors from an imageBuffer and by lanes from a plain buffer, while stores
// are slower to the former: pixels are stored as structs and loaded as texels. Neither can be handed to a function.
#ifndef LUMULUS_LIB_PIXEL
#define LUMULUS_LIB_PIXEL

#include "shared/draw.h"

Pixel pixelOf(vec4 a, vec4 b, vec4 c) { return Pixel(a.rgb, a.a, b.x, b.y, b.z, vec3(b.w, c.xy), vec2(0.0)); }

#define LOAD_PIXEL(texels, index)                                                                     \
    pixelOf(imageLoad(texels, PIXEL_TEXELS * (index)), imageLoad(texels, PIXEL_TEXELS * (index) + 1), \
            imageLoad(texels, PIXEL_TEXELS * (index) + 2))

#define STORE_PIXEL(buffer, index, value)              \
    buffer[index].cloud = value.cloud;                 \
    buffer[index].transmittance = value.transmittance; \
    buffer[index].alpha = value.alpha;                 \
    buffer[index].depth = value.depth;                 \
    buffer[index].front = value.front;                 \
    buffer[index].radiance = value.radiance

#endif
