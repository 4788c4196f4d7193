#version 460
#extension GL_GOOGLE_include_directive : require
// Fog in the light of sun and sky: what it sends towards the eye from before and behind the clouds, and what it leaves of
// all that is seen through it. Without clouds the light is a difference of that at both ends of a path (fog_light.h); where
// clouds throw shadows, the sun's light that is missing there is taken off step by step. What clouds change in the light that
// fog scatters more often is known beforehand (light/fog_change/fog_change.h).
#include "shared/lit_fog.h"
#include "lib/view.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 4) const bool MANY = false;      // more than one cloud
layout(constant_id = 6) const bool GROUND = false;
layout(constant_id = 20) const bool SHADOWS = false;  // clouds or meshes throw shadows
layout(constant_id = 24) const bool AIR = false;      // the sky is an atmosphere's, whose planet is round
layout(constant_id = 25) const bool CHANGED = false;  // clouds change the light of the fog
layout(binding = 0, rgba32f) uniform image2D cloud;
layout(binding = 1, rgba32f) uniform image2D radiance;
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3, scalar) readonly buffer Params { LitFogParams storedParams; };
layout(binding = 4, scalar) readonly buffer Media { FogMedium media[]; };
layout(binding = 5) uniform sampler2D levelTable;   // which level lies at a height
layout(binding = 6) uniform sampler3D scattered;    // FogLight::scattered(): columns, rows, levels
layout(binding = 7) uniform sampler3D onceScattered;  // FogLight::once(): rows, levels, media
layout(binding = 10) uniform sampler2D groundSeen;  // RGB: radiance; alpha: share of the pixel
// What clouds send more or less than the fog without them would; what of it is scattered on its way is spread by the filter.
layout(binding = 11, rgba32f) uniform writeonly image2D moreLight;
layout(binding = 12, rgba32f) uniform writeonly image2D lessLight;
layout(binding = 13, scalar) buffer Summary { LitFogSummary summary; };
layout(binding = 34) uniform sampler2D skyBehind;   // radiance of the sky, where it differs
layout(binding = 35) uniform sampler3D changeSeen;  // ChangeSeen: columns, rows, depths

// Held in registers: a load from a buffer costs a loop over the lanes on lavapipe.
LitFogParams params;
FogMedium first;
#include "lib/mesh_shadow.glsl"
#include "lib/lit_fog_ray.glsl"
#include "lib/lit_fog_depth.glsl"
#include "lib/taken_light.glsl"

/// Parts of a path in which shadows are looked for.
const int STEPS = 12;

float levelAt(float height) {
    const float place = clamp(height / params.height, 0.0, 1.0) * float(FOG_HEIGHTS - 1);
    return textureLod(levelTable, vec2((place + 0.5) / float(FOG_HEIGHTS), 0.5), 0.0).r;
}

/// The sun's light that the fog scatters once, over its opacity along a row.
vec3 onceAt(float level, float row, float cosine) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < params.media; ++i) {
        const vec3 place = vec3((row + 0.5) / float(2 * FOG_ROWS), (level + 0.5) / float(params.levels),
                                (float(i) + 0.5) / float(params.media));
        sum += fogPhase(i == 0 ? first.g : media[i].g, cosine) * textureLod(onceScattered, place, 0.0).rgb;
    }
    return params.sunIrradiance * sum;
}

/// All light of the fog that is seen from a height, over its opacity along the ray.
vec3 lightAt(Ray ray, float height) {
    const float level = levelAt(height), row = ray.side * float(FOG_ROWS) + ray.row;
    const vec3 place = vec3((ray.column + 0.5) / float(FOG_COLUMNS), (row + 0.5) / float(2 * FOG_ROWS),
                            (level + 0.5) / float(params.levels));
    return textureLod(scattered, place, 0.0).rgb + onceAt(level, row, ray.cosine);
}

float heightAt(Ray ray, float distance_) { return params.eyeHeight + ray.origin.y + distance_ * ray.direction.y; }

/// The sun's light that fog scatters once and clouds keep off: x to y of the ray's distances and, where `second`, y to z. What a step has of
/// it without clouds is a difference of that at both ends, exact however long the step is; `all`: the ray's optical depth.
mat2x3 shadowed(Ray ray, vec3 ends, bool second, float offset, vec3 all) {
    mat2x3 sums = mat2x3(0.0);
    vec3 before = vec3(0.0), lightBefore = vec3(0.0);
    const float row = ray.side * float(FOG_ROWS) + ray.row;
    float thickness = 0.0, near = 0.0;
    for (int i = 0; i < (second ? 2 : 1) * (STEPS + 2); ++i) {
        // of each part first the depth of its end, then that of its beginning
        const int part = i / (STEPS + 2), step = i - part * (STEPS + 2) - 2;
        const float from = part == 0 ? ends.x : max(ends.x, ends.y), to = part == 0 ? ends.y : ends.z;
        if (from >= to) continue;
        const float share = step < 0 ? (step == -2 ? 1.0 : 0.0) : shareOfWay(thickness, float(step + 1) / float(STEPS));
        const float far = mix(from, to, min(share, 1.0));
        const vec3 after = depthTo(ray, far).extinction;
        const float level = levelAt(heightAt(ray, far));
        const vec3 opacity = max(exp(-after) - exp(-all), 0.0), light = onceAt(level, row, ray.cosine) * opacity;
        if (step >= 0) {
            const float at = mix(near, far, offset);
            const vec3 point = ray.start + at * ray.towards;
            sums[part] += (1.0 - throughClouds(point) * throughMeshes(point)) * max(lightBefore - light, 0.0);
        } else if (step == -1) {
            const vec3 all = before - after;  // `before` is the depth of the end here
            thickness = min(all.x, min(all.y, all.z));
        }
        before = after;
        lightBefore = light;
        near = far;
    }
    return sums;
}

/// The part of a ray in which shadows of clouds may lie.
vec2 rangeOfShadows(Ray ray, float limit) {
    vec2 range = vec2(limit, 0.0);
    for (int caster = 0; caster < params.casters + params.meshes; ++caster) {
        const vec2 one = shadowRange(CASTER_TEXELS * caster, ray.start, ray.towards);
        if (one.x < one.y) range = vec2(min(range.x, one.x), max(range.y, one.y));
    }
    // in no fog there are none
    const float rise = ray.direction.y, height = params.eyeHeight + ray.origin.y;
    const float one = -height / rise, other = (params.height - height) / rise;
    if (abs(rise) > 1.0e-6) range = vec2(max(range.x, min(one, other)), min(range.y, max(one, other)));
    return vec2(range.x, min(range.y, limit));
}

/// What clouds change in the light that the fog sends from the first metres of a pixel's way.
vec3 changeAt(ivec2 pixel, float distance_) {
    const vec2 place = (vec2(params.first + pixel) + 0.5) / vec2(params.view.size);
    const float depth = sqrt(clamp((distance_ - params.changeNear) / (params.changeFar - params.changeNear), 0.0, 1.0));
    return textureLod(changeSeen, (vec3(place, depth) * (params.changeSize - 1.0) + 0.5) / params.changeSize, 0.0).rgb;
}

/// Leaves what a cloud at a distance sends more or less than `without` for the filter.
void leaveForFilter(ivec2 pixel, vec4 front, vec3 share, vec3 without, float away) {
    const vec3 excess = front.a > 0.0 ? share * (front.rgb - front.a * without) : vec3(0.0);
    const vec3 more = max(excess, 0.0), less = max(-excess, 0.0);
    imageStore(moreLight, pixel, vec4(more, 0.0));
    imageStore(lessLight, pixel, vec4(less, 0.0));
    if (any(greaterThan(more, vec3(0.0)))) atomicOr(summary.more, 1u);
    if (any(greaterThan(less, vec3(0.0)))) atomicOr(summary.less, 1u);
    if (front.a > 0.0) atomicMax(summary.farthest, floatBitsToUint(away));
}

void main() {
    params = storedParams;
    first = media[0];
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance)))) return;
    Ray ray;
    if (!rayOf(params.first + pixel, ray)) {
        imageStore(moreLight, pixel, vec4(0.0));
        imageStore(lessLight, pixel, vec4(0.0));
        return;
    }
    vec4 front = imageLoad(cloud, pixel);
    const vec4 seen = imageLoad(radiance, pixel);
    vec3 behind = seen.rgb - front.rgb, beyond = params.sky;
    if (AIR) beyond = params.aboveTop > 0.0 ? vec3(0.0) : texelFetch(skyBehind, pixel, 0).rgb;
    float limit = FAR_DEPTH;
    if (GROUND) {
        const vec4 ground = texelFetch(groundSeen, pixel, 0);
        behind = mix(behind, (1.0 - front.a) * ground.rgb, ground.a);
        beyond = mix(beyond, ground.rgb, ground.a);
        const float above = params.aboveGround + ray.origin.y;
        if (ray.direction.y < 0.0) limit = max(above, 0.0) / -ray.direction.y;
    }
    const float away = clamp(texelFetch(depth, pixel, 0).r - ray.entry, 0.0, limit);
    Depth depths[2];
    vec3 lights[2];
    for (int i = 0; i < 2; ++i) {
        depths[i] = depthTo(ray, i == 0 ? limit : away);
        lights[i] = lightAt(ray, heightAt(ray, i == 0 ? 0.0 : away));
    }
    const vec3 all = depths[0].extinction;
    vec3 ofAll = lights[0] * (1.0 - exp(-all)), ofFront = vec3(0.0), through = vec3(1.0), without = vec3(0.0);
    if (front.a > 0.0) {
        through = exp(-depths[1].extinction);
        const vec3 rest = exp(-max(all - depths[1].extinction, 0.0)), there = lights[1] * (1.0 - rest);
        ofFront = ofAll - through * there;
        without = there + rest * beyond;
    }
    // by how much less the fog dims light where what its peaks scatter counts as not scattered
    leaveForFilter(pixel, front, exp(depths[1].peak - depths[1].extinction), without, away + ray.entry);
    vec3 takenFront = vec3(0.0), takenAll = vec3(0.0);
    if (SHADOWS) {
        const vec2 range = rangeOfShadows(ray, limit);
        // interleaved gradient noise (Jimenez 2014)
        const float offset = fract(52.9829189 * fract(dot(vec2(params.first + pixel) + 0.5, vec2(0.06711056, 0.00583715))));
        const float middle = front.a > 0.0 ? min(range.y, away) : range.y;
        const mat2x3 hidden = shadowed(ray, vec3(range.x, middle, range.y), front.a > 0.0 && front.a < 0.999, offset, all);
        takenFront = hidden[0];
        takenAll = hidden[0] + hidden[1];
    }
    if (CHANGED) {
        takenAll -= changeAt(pixel, FAR_DEPTH);
        if (front.a > 0.0) takenFront -= changeAt(pixel, away + ray.entry);
    }
    ofFront = leftOf(ofFront, takenFront);
    ofAll = leftOf(ofAll, takenAll);
    front.rgb = front.rgb * through + front.a * max(ofFront, 0.0);
    imageStore(cloud, pixel, front);
    imageStore(radiance, pixel, vec4(front.rgb + (1.0 - front.a) * max(ofAll, 0.0) + exp(-all) * behind, seen.a));
}
