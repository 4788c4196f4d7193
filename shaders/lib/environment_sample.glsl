// Directions of photons of a sky that differs by direction: an alias table over a map (sky/sky_maps.h). Where they enter is
// not decided here (lib/emission.glsl).
#ifndef LUMULUS_LIB_ENVIRONMENT_SAMPLE
#define LUMULUS_LIB_ENVIRONMENT_SAMPLE

#include "shared/air_light.h"

layout(binding = 13, scalar) readonly buffer SkyCells { SkyCell skyCells[]; };
layout(binding = 14, scalar) readonly buffer SunColours { vec3 sunColours[]; };

/// The cell that light comes from, by two numbers in [0,1).
uint skyCell(float u, float keep) {
    const uint count = uint(SKY_MAP_COLUMNS * SKY_MAP_ROWS);
    const uint cell = min(uint(u * float(count)), count - 1u);
    return keep < skyCells[cell].keep ? cell : skyCells[cell].other;
}

/// Direction of travel of light from a cell, uniform over its solid angle. `axes`: from the map to the world.
vec3 skyTravel(mat3 axes, uint cell, vec2 u) {
    const float step = 3.14159265 / float(SKY_MAP_ROWS), row = float(cell / uint(SKY_MAP_COLUMNS));
    const float up = mix(cos(step * row), cos(step * (row + 1.0)), u.y);
    const float azimuth = 6.28318531 / float(SKY_MAP_COLUMNS) * (float(cell % uint(SKY_MAP_COLUMNS)) + u.x);
    const float across = sqrt(max(0.0, 1.0 - up * up));
    return -(axes * vec3(across * cos(azimuth), up, across * sin(azimuth)));
}

/// Weight of a photon from a cell that enters at this height, 0 to 1, by the area that its direction sees of the box.
vec3 skyWeight(uint cell, float height, float area) {
    return mix(skyCells[cell].low, skyCells[cell].high, height) * area;
}

/// The sun's light at a place of the cloud, against the most that it has anywhere in it.
vec3 sunColour(vec2 place) {
    const vec2 at = place * vec2(SUN_COLOUR_COLUMNS - 1, SUN_COLOUR_ROWS - 1);
    const ivec2 base = min(ivec2(at), ivec2(SUN_COLOUR_COLUMNS - 2, SUN_COLOUR_ROWS - 2));
    const vec2 between = at - vec2(base);
    const int first = base.y * SUN_COLOUR_COLUMNS + base.x;
    return mix(mix(sunColours[first], sunColours[first + 1], between.x),
               mix(sunColours[first + SUN_COLOUR_COLUMNS], sunColours[first + SUN_COLOUR_COLUMNS + 1], between.x),
               between.y);
}

#endif
