// A layer whose value is the same in all pixels is an image of one texel.
#ifndef LUMULUS_LIB_UNIFORM_LAYER
#define LUMULUS_LIB_UNIFORM_LAYER

vec4 layerTexel(sampler2D layer, ivec2 pixel) {
    return texelFetch(layer, min(pixel, textureSize(layer, 0) - 1), 0);
}

#endif
