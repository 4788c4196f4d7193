// Fog: analytic media and what they make of light, the same on both sides. Metres relative to the eye.
// Elek, Ritschel, Seidel 2013 and Iser 2017, in forms that stay finite in float.
#ifndef LUMULUS_SHARED_FOG_H
#define LUMULUS_SHARED_FOG_H

#include "shared/draw.h"

SHARED_BEGIN

const int MEDIUM_HOMOGENEOUS = 0;
const int MEDIUM_EXPONENTIAL = 1;
const int MEDIUM_SPHERE = 2;
const int MEDIUM_ELLIPSOID = 3;
const int MEDIUM_BOX = 4;

/// Distance to a bottom or top that does not exist, metres.
const float ENDLESS = 1.0e30F;
/// Largest ∫ϱ: products with coefficients of 1e6/m stay far below the largest float.
const float MAX_DENSITY_INTEGRAL = 1.0e20F;
/// Largest spread in pixels: thousands of times the widest picture.
const float MAX_SPREAD = 1.0e8F;

struct FogMedium {
    int kind;
    vec3 scattering;  // where ϱ = 1, 1/m
    vec3 absorption;
    vec3 emission;  // W/(m³ sr)
    float g;
    vec3 axis;        // exponential: unit vector towards thinner fog
    float falloff;    // 1/m
    float eyeHeight;  // of the eye above the offset, along the axis
    vec3 center;      // sphere, ellipsoid, box
    float radius;     // sphere
    vec3 halfSize;    // ellipsoid, box
    // homogeneous, exponential: a layer that is level. ENDLESS where it has no bottom or no top
    float aboveBottom;  // height of the eye above the bottom
    float belowTop;     // depth of the eye below the top
    float thickness;
    int bounded;  // not 0: every vertical line has a finite optical depth, and the sky's distance is no end
};

/// Part of a path, metres from its origin.
struct FogPart {
    float begin;
    float metres;  // its length
};

/// What lies between the eye and a point.
struct FogPath {
    vec3 scattering;  // optical depths
    vec3 absorption;
    vec3 emission;   // ∫ e ϱ: radiance that would arrive unhindered
    float turning;   // B = Σ C_s (1−g) P, of the luminance
    float absorbed;  // A = Σ C_a P, of the luminance
};

/// Preparation of a picture's light, a ray a pixel.
struct FogPush {
    ViewParams view;
    float pixelsPerRadian;  // the same in the whole picture; pixels per metre for an orthographic view
    float skyDistance;
    int media;
    int last;  // number of the coarsest level of the scattering pyramid
};

/// Two neighbouring levels of a pyramid, all of which lie in one image.
struct LevelPush {
    ivec2 finerOffset;
    ivec2 finerSize;
    ivec2 coarserOffset;
    ivec2 coarserSize;
    vec2 finerExtent;   // where the picture ends in the finer one: its size, unless halving left a fraction
    vec2 inverseImage;  // 1 / size of the image in texels
    int level;          // number of the coarser one
    int last;           // number of the coarsest
    float levelScale;   // c: level k spreads by about c 2^k pixels
};

/// Separation of bright near pixels: light is separated above the luminance and below the spread, smoothly.
struct SeparationPush {
    ivec2 size;
    float strength;
    float luminance;
    float spread;  // pixels
};

/// Composition of a filter that gathers.
struct FetchPush {
    ivec2 size;
    vec2 inverseImage;
    int last;
    float levelScale;
    int depthLookups;
    float separationLevel;
};

/// What is added to a picture of light that a filter has spread, or taken off where `sign_` is below 0.
struct FogSpreadPush {
    ViewParams view;
    float skyDistance;
    int media;
    float sign_;
    ivec2 margin;  // of the filtered light [pixels]
};

/// A margin around light that is to be filtered [pixels].
struct FogMarginPush {
    ivec2 margin;
};

/// A band of sources of the exact filter.
struct ExactPush {
    ivec2 size;
    int firstRow;
    int rows;
};

SHARED_FN float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126F, 0.7152F, 0.0722F));
}

/// (1 − e^(−x)) / x for x ≥ 0.
SHARED_FN float meanTransmittance(float x) {
    if (x < 0.1F) return 1.0F - x * (0.5F - x * (1.0F / 6.0F - x * (1.0F / 24.0F - x / 120.0F)));
    return (1.0F - exp(-x)) / x;
}

SHARED_FN vec3 meanTransmittance(vec3 x) {
    return vec3(meanTransmittance(x.x), meanTransmittance(x.y), meanTransmittance(x.z));
}

/// ∫ e^(−b h) along a straight path of `distance` between the heights h0 and h1.
SHARED_FN float exponentialIntegral(float falloff, float h0, float h1, float distance) {
    const float highest = exp(min(-falloff * min(h0, h1), 80.0F));
    return min(distance * highest * meanTransmittance(falloff * abs(h1 - h0)), MAX_DENSITY_INTEGRAL);
}

/// ∫ (1 − r²/R²) along the part of the path that lies in the sphere, from the closest approach outwards: differences of
/// squares of the distance to a far sphere would have no digits left.
SHARED_FN float sphereIntegral(vec3 center, float radius, vec3 origin, vec3 direction, float distance) {
    const vec3 toEye = origin - center;
    const float closest = -dot(toEye, direction);
    const vec3 across = cross(toEye, direction);
    const float miss = sqrt(dot(across, across));
    if (miss >= radius) return 0.0F;
    const float square = (radius - miss) * (radius + miss), half_ = sqrt(square);
    const float first = max(-closest, -half_), last = min(distance - closest, half_);
    if (last <= first) return 0.0F;
    const float middle = 0.5F * (first + last), reach = 0.5F * (last - first);
    const float mean = (half_ - middle) * (half_ + middle) - reach * reach / 3.0F;
    return 2.0F * (reach / radius) * max(mean / radius, 0.0F);
}

/// Metres of the path within an ellipsoid; from the closest approach outwards as in the sphere.
SHARED_FN float ellipsoidLength(vec3 center, vec3 halfSize, vec3 origin, vec3 direction, float distance) {
    const vec3 toEye = (origin - center) / halfSize, along = direction / halfSize;
    const float perMetre = sqrt(dot(along, along));
    const vec3 unit = along / perMetre, across = cross(toEye, unit);
    const float miss = sqrt(dot(across, across));
    if (miss >= 1.0F) return 0.0F;
    const float closest = -dot(toEye, unit), half_ = sqrt((1.0F - miss) * (1.0F + miss));
    return max(min(distance * perMetre - closest, half_) - max(-closest, -half_), 0.0F) / perMetre;
}

/// Metres of the path within a box.
SHARED_FN float boxLength(vec3 center, vec3 halfSize, vec3 origin, vec3 direction, float distance) {
    const vec3 toEye = origin - center;
    float first = 0.0F, last = distance;
    for (int axis = 0; axis < 3; ++axis) {
        const float d = direction[axis], from = -halfSize[axis] - toEye[axis], to = halfSize[axis] - toEye[axis];
        if (abs(d) < 1.0e-30F) {
            if (from > 0.0F || to < 0.0F) return 0.0F;
            continue;
        }
        first = max(first, min(from / d, to / d));
        last = min(last, max(from / d, to / d));
    }
    return max(last - first, 0.0F);
}

/// The part of a path between bottom and top of a layer. `height`: of the path's origin above the eye; `rise`: metres
/// upwards a metre. A layer that is crossed whole has its own thickness, whatever digits its distance has.
SHARED_FN FogPart partInLayer(FogMedium medium, float height, float rise, float distance) {
    const float above = medium.aboveBottom + height, below = medium.belowTop - height;
    const float risen = rise * distance, steepness = abs(rise);
    if (abs(risen) < 1.0e-30F) return FogPart(0.0F, above >= 0.0F && below >= 0.0F ? distance : 0.0F);
    const float low = max(min(risen, 0.0F), -above), high = min(max(risen, 0.0F), below);
    if (high <= low) return FogPart(0.0F, 0.0F);
    const float crossed = low == -above && high == below ? medium.thickness : high - low;
    return FogPart((rise > 0.0F ? low : -high) / steepness, min(crossed / steepness, distance));
}

/// P = ∫ ϱ from `origin` along the unit vector `direction` [m]. Media without an end stop at `skyDistance`.
SHARED_FN float densityIntegral(FogMedium medium, vec3 origin, vec3 direction, float distance, float skyDistance) {
    if (medium.kind == MEDIUM_SPHERE) return sphereIntegral(medium.center, medium.radius, origin, direction, distance);
    if (medium.kind == MEDIUM_ELLIPSOID)
        return ellipsoidLength(medium.center, medium.halfSize, origin, direction, distance);
    if (medium.kind == MEDIUM_BOX) return boxLength(medium.center, medium.halfSize, origin, direction, distance);
    FogPart part = FogPart(0.0F, medium.bounded != 0 ? distance : min(distance, skyDistance));
    if (medium.thickness < ENDLESS || medium.aboveBottom < ENDLESS || medium.belowTop < ENDLESS)
        part = partInLayer(medium, origin.y, direction.y, part.metres);
    if (medium.kind == MEDIUM_HOMOGENEOUS) return min(part.metres, MAX_DENSITY_INTEGRAL);
    const float start = medium.eyeHeight + dot(origin, medium.axis), rise = dot(direction, medium.axis);
    const float begin = start + part.begin * rise;
    return exponentialIntegral(medium.falloff, begin, begin + part.metres * rise, part.metres);
}

SHARED_FN FogPath clearPath() {
    return FogPath(vec3(0.0F), vec3(0.0F), vec3(0.0F), 0.0F, 0.0F);
}

SHARED_FN void addMedium(INOUT(FogPath) path, FogMedium medium, float densityIntegral_) {
    path.scattering += medium.scattering * densityIntegral_;
    path.absorption += medium.absorption * densityIntegral_;
    path.emission += medium.emission * densityIntegral_;
    path.turning += luminance(medium.scattering) * (1.0F - medium.g) * densityIntegral_;
    path.absorbed += luminance(medium.absorption) * densityIntegral_;
}

/// Variance of the angle [rad²] by which light of a point is spread (Premože 2004, in optical depths, see
/// docs/fog.md). Finite for every path.
SHARED_FN float spreadVariance(FogPath path) {
    const float b = path.turning, a = path.absorbed;
    return b > 1.0F ? 1.0F / (8.0F / b + 4.0F / 3.0F * a) : b / (8.0F + 4.0F / 3.0F * a * b);
}

/// Share of the light that arrives as it left.
SHARED_FN vec3 attenuatedShare(FogPath path) {
    return exp(-(path.scattering + path.absorption));
}

/// Share that arrives scattered: with attenuatedShare e^(−absorption).
SHARED_FN vec3 scatteredShare(FogPath path) {
    return exp(-path.absorption) * path.scattering * meanTransmittance(path.scattering);
}

/// Radiance that the fog itself sends; exact where all its media have the same shape.
SHARED_FN vec3 emittedRadiance(FogPath path) {
    return path.emission * meanTransmittance(path.scattering + path.absorption);
}

/// Variance [pixels²] by which a level of a pyramid has spread light that goes down to it and comes back up.
/// `stepVariance` is that of one step: of the filter down and of the interpolation up, in pixels of the finer level.
SHARED_FN float levelVariance(float stepVariance, int level) {
    return stepVariance * (pow(4.0F, float(level)) - 1.0F) / 3.0F;
}

#ifdef __cplusplus
static_assert(sizeof(FogMedium) == 108 && offsetof(FogMedium, bounded) == 104);
static_assert(sizeof(FogPush) == 72 && offsetof(FogPush, last) == 68);
static_assert(sizeof(LevelPush) == 60 && offsetof(LevelPush, levelScale) == 56);
static_assert(sizeof(SeparationPush) == 20 && offsetof(SeparationPush, spread) == 16);
static_assert(sizeof(FetchPush) == 32 && offsetof(FetchPush, separationLevel) == 28);
static_assert(sizeof(FogSpreadPush) == 76 && offsetof(FogSpreadPush, margin) == 68);
static_assert(sizeof(FogMarginPush) == 8);
static_assert(sizeof(ExactPush) == 16 && offsetof(ExactPush, rows) == 12);
#endif

SHARED_END

#endif
