#version 460
#extension GL_GOOGLE_include_directive : require
// For each source of a band of rows: the shares of its light that arrive in each column and in each row of a picture that
// mirrors at its borders. Their product is the exact filter of the model: a Gaussian integrated over pixels.
#include "shared/fog.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const int AXIS = 0;
layout(binding = 0) uniform sampler2D scattered;  // alpha: spread
layout(binding = 1) uniform writeonly image2D shares;  // [source of the band][pixel along the axis]
layout(push_constant, scalar) uniform Push { ExactPush push; };

/// Beyond this many standard deviations nothing of a Gaussian is left in a float: e^(−6.5²/2) = 7e-10.
const float REACH = 6.5;
/// Share of the picture's side up to which a spread is summed over its mirror images, above it as a Fourier series.
const float WIDE = 0.3;

/// e^(x²) erfc(x) e^(−x²) for x ≥ 0, to 1.2e-7 of its value (Press et al. 1992, erfcc).
float complementaryError(float x) {
    const float t = 1.0 / (1.0 + 0.5 * x);
    const float p =
        -1.26551223 +
        t * (1.00002368 +
             t * (0.37409196 +
                  t * (0.09678418 +
                       t * (-0.18628806 +
                            t * (0.27886807 + t * (-1.13520398 + t * (1.48851587 + t * (-0.82215223 + t * 0.17087277))))))));
    return t * exp(p - x * x);
}

/// Share of a Gaussian that falls on the pixel whose middle is `offset` away.
float onPixel(float offset, float spread) {
    const float scale = 0.70710678 / spread, away = abs(offset);
    const float near = (away - 0.5) * scale, far = (away + 0.5) * scale;
    // the near edge of the pixel in the middle lies on the other side
    return near < 0.0 ? 1.0 - 0.5 * (complementaryError(-near) + complementaryError(far))
                      : 0.5 * (complementaryError(near) - complementaryError(far));
}

/// Share of the light of pixel `from` that arrives at `to`, along one axis of `count` pixels.
float axisShare(int to, int from, int count, float spread) {
    const float n = float(count);
    if (spread > WIDE * n) {  // the theta function of a line with mirrors at both ends
        float sum = 1.0;
        for (int m = 1; m <= 7; ++m) {
            const float k = 3.14159265 * float(m) / n;
            const float box = sin(0.5 * k) / (0.5 * k);
            sum += 2.0 * exp(-0.5 * k * k * spread * spread) * box * cos(k * (float(to) + 0.5)) * cos(k * (float(from) + 0.5));
        }
        return max(sum, 0.0) / n;
    }
    const float narrow = max(spread, 1.0e-3);
    float sum = 0.0;
    for (int i = -1; i <= 1; ++i) {
        const float shift = float(2 * i * count);
        const float direct = float(to - from) - shift, mirror = float(to + from + 1) - shift;
        if (abs(direct) < REACH * narrow + 1.0) sum += onPixel(direct, narrow);
        if (abs(mirror) < REACH * narrow + 1.0) sum += onPixel(mirror, narrow);
    }
    return sum;
}

void main() {
    const ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    const int count = push.size[AXIS];
    if (place.x >= count || place.y >= push.rows * push.size.x) return;
    const ivec2 source = ivec2(place.y % push.size.x, push.firstRow + place.y / push.size.x);
    const float spread = texelFetch(scattered, source, 0).a;
    imageStore(shares, place, vec4(axisShare(place.x, source[AXIS], count, spread)));
}
