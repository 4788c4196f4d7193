#version 460
#extension GL_GOOGLE_include_directive : require
// How each cell of the light field follows from the cells around it, whatever the view: the mean of what they have, each at
// the middle of its mass, about a plane through them (moving least squares: Lancaster and Salkauskas 1981). That is a sum
// over the cells, with weights that are linear in their places. So the outermost cells have the light of their own depth, not
// of what lies behind them, and the empty cells beside them what it falls to beyond the surface.
#include "shared/draw.h"
#include "lib/light_cell.glsl"
#include "lib/linear.glsl"

layout(local_size_x = 64) in;
layout(binding = 0, rg32f) uniform readonly image3D trust;  // own share, 1 + sharpness where there is density
layout(binding = 1, rgba8) uniform readonly image3D massCentres;  // from the lower corner [cells]
layout(binding = 2, scalar) readonly buffer LitCells { uint litCells[]; };
layout(binding = 3, rgba32f) uniform writeonly imageBuffer planes;  // of each: by place and anywhere; 1 / Σ weights, own share, cells around
layout(push_constant, scalar) uniform Push { LightFieldPush push; };

/// Added to the variance of the places [cells²], so that slopes are small that few cells tell, and those that are noise: by
/// how sharp the light may be (light_counts.comp).
const float LEAST_RIDGE = 0.02, RIDGE = 8.0;

void main() {
    const uint entry = linearInvocation(64u);
    if (entry >= push.lit) return;
    const ivec3 cell = cellNumbered(litCells[entry], push.grid);
    const vec2 own = imageLoad(trust, cell).xy;
    const int reach = own.y > 0.0 ? 1 : 2;
    float weights = 0.0, sharpness = 0.0;
    vec3 place = vec3(0.0);
    mat3 places = mat3(0.0);  // Σ place placeᵀ
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const ivec3 by = ivec3(x, y, z);
                const ivec3 other = cell + by;
                if (any(lessThan(other, ivec3(0))) || any(greaterThanEqual(other, push.grid))) continue;
                const float there = imageLoad(trust, other).y;
                if (there <= 0.0) continue;
                const float weight = cellWeight(by, reach);
                const vec3 at = vec3(by) + imageLoad(massCentres, other).xyz - 0.5;
                weights += weight;
                sharpness += there - 1.0;
                place += weight * at;
                places += weight * outerProduct(at, at);
            }
    const int at = 2 * int(entry);
    if (weights <= 0.0) {
        imageStore(planes, at, vec4(0.0));
        imageStore(planes, at + 1, vec4(0.0));
        return;
    }
    place /= weights;
    places = places / weights - outerProduct(place, place);
    for (int i = 0; i < 3; ++i) places[i][i] += LEAST_RIDGE + RIDGE / max(sharpness, 1.0e-6);
    // The slope is Σ w light (at − place)ᵀ places⁻¹ / Σ w. The plane is looked up at the cell's own place, 0, and what the
    // cell has itself is taken there along the slope from the middle of its mass.
    const float share = own.y > 0.0 ? own.x : 0.0;
    const vec3 along = share * (imageLoad(massCentres, cell).xyz - 0.5) + (1.0 - share) * place;
    const vec3 byPlace = -inverse(places) * along;
    imageStore(planes, at, vec4(byPlace, 1.0 - share - dot(byPlace, place)) / weights);
    imageStore(planes, at + 1, vec4(1.0 / weights, share, float(reach), 0.0));
}
