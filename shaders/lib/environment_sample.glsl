// Directions of photons of a sky that differs by direction: an alias table over a map (sky/sky_maps.h, sky/map_sky.h). Where they enter is
// not decided here (lib/emission.glsl).
#ifndef LUMULUS_LIB_ENVIRONMENT_SAMPLE
#define LUMULUS_LIB_ENVIRONMENT_SAMPLE

#include "shared/air_light.h"

layout(constant_id = 19) const bool FOG = false;  // light of fog differs by height more than a line can tell
// Cells of the map: columns by azimuth, rows from the zenith down.
layout(constant_id = 16) const int SKY_CELL_COLUMNS = 64;
layout(constant_id = 17) const int SKY_CELL_ROWS = 32;

layout(binding = 13, scalar) readonly buffer SkyCells { SkyCell skyCells[]; };
layout(binding = 14, scalar) readonly buffer SunColours { vec3 sunColours[]; };
layout(binding = 26, scalar) readonly buffer FogSky { vec3 fogSky[]; };  // AirLight::fogSky

/// The cell that light comes from, by two numbers in [0,1).
uint skyCell(float u, float keep) {
    const uint count = uint(SKY_CELL_COLUMNS * SKY_CELL_ROWS);
    const uint cell = min(uint(u * float(count)), count - 1u);
    return keep < skyCells[cell].keep ? cell : skyCells[cell].other;
}

/// Direction of travel of light from a cell, uniform over its solid angle. `axes`: from the map to the world.
vec3 skyTravel(mat3 axes, uint cell, vec2 u) {
    const float step = 3.14159265 / float(SKY_CELL_ROWS), row = float(cell / uint(SKY_CELL_COLUMNS));
    const float up = mix(cos(step * row), cos(step * (row + 1.0)), u.y);
    const float azimuth = 6.28318531 / float(SKY_CELL_COLUMNS) * (float(cell % uint(SKY_CELL_COLUMNS)) + u.x);
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

/// Of the heights of fogSky: the lower one, and the share of the next.
vec2 fogPlace(float height) {
    const float place = height * float(FOG_SKY_HEIGHTS - 1);
    const float lower = min(floor(place), float(FOG_SKY_HEIGHTS - 2));
    return vec2(lower, place - lower);
}

/// What light that travels so weighs for each m² where it is first scattered.
vec3 fogSkyWeight(mat3 axes, vec3 direction, float height) {
    const vec3 towards = -direction * axes;
    const uint row = min(uint(acos(clamp(towards.y, -1.0, 1.0)) / 3.14159265 * float(SKY_CELL_ROWS)), uint(SKY_CELL_ROWS - 1));
    const float turn = fract(atan(towards.z, towards.x) / 6.28318531 + 1.0);
    const uint cell = row * uint(SKY_CELL_COLUMNS) + min(uint(turn * float(SKY_CELL_COLUMNS)), uint(SKY_CELL_COLUMNS - 1));
    const vec2 place = fogPlace(height);
    const uint at = uint(place.x) * uint(SKY_CELL_COLUMNS * SKY_CELL_ROWS) + cell;
    return mix(fogSky[at], fogSky[at + uint(SKY_CELL_COLUMNS * SKY_CELL_ROWS)], place.y);
}

/// What the weight of a photon is multiplied by where it is first scattered. `place`: airPlace().
vec3 firstLight(bool ofSun, mat3 axes, vec3 direction, vec2 place) {
    if (ofSun) return sunColour(place);
    return FOG ? fogSkyWeight(axes, direction, place.y) : vec3(1.0);
}

/// Share of light that comes through the fog between the ground and a height of the cloud, along a direction.
vec3 throughFogBelow(float height, float up) {
    const vec2 place = fogPlace(height);
    const uint at = uint(FOG_SKY_HEIGHTS * SKY_CELL_COLUMNS * SKY_CELL_ROWS) + uint(place.x);
    return exp(-mix(fogSky[at], fogSky[at + 1u], place.y) / max(abs(up), 1.0e-3));
}

#endif
