// What sample_hg.comp is told and what it gives back.
#ifndef LUMULUS_TESTS_SAMPLE_HG_H
#define LUMULUS_TESTS_SAMPLE_HG_H

#include "shared/prelude.h"

SHARED_BEGIN

struct SampleHgPush {
    vec3 from;  // unit vector that is turned
    float g;
    float scatterFraction;
    uint stream;
    uint count;
};

struct SampledDirection {
    vec4 uniform4;  // the random numbers, to be compared bit by bit
    vec3 angle;     // 1 − cos θ, 1 + cos θ, sin θ
    vec3 to;
};

SHARED_END

#endif
