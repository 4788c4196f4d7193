// An interface struct with every kind of member that scalar layout packs unlike std430.
#ifndef LUMULUS_TESTS_GPU_INTERFACE_H
#define LUMULUS_TESTS_GPU_INTERFACE_H

#include "shared/prelude.h"

SHARED_BEGIN

struct Inner {
    vec3 direction;
    float weight;
    vec2 pair;
};

struct Outer {
    float first;
    vec3 position;
    uint64_t total;
    Inner inner[2];
    mat3 rotation;
    ivec3 cell;
    uint last;
};

struct ScalePush {
    uint64_t bias;
    uint count;
};

SHARED_END

#endif
