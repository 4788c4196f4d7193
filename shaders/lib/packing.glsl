// Compact photon records: a direction in 32 bits, an RGB power in 64.
#ifndef LUMULUS_LIB_PACKING
#define LUMULUS_LIB_PACKING

/// Octahedral map (Meyer et al. 2010), 16 bits each way: at most 4e-5 rad off.
uint packDirection(vec3 d) {
    vec2 p = d.xy / (abs(d.x) + abs(d.y) + abs(d.z));
    if (d.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return packSnorm2x16(p);
}

vec3 unpackDirection(uint bits) {
    const vec2 p = unpackSnorm2x16(bits);
    vec3 d = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    const float fold = max(-d.z, 0.0);
    d.x += d.x < 0.0 ? fold : -fold;
    d.y += d.y < 0.0 ? fold : -fold;
    return normalize(d);
}

uvec2 packPower(vec3 power) {
    const uvec3 p = uvec3(clamp(power + 0.5, vec3(0.0), vec3(2097151.0)));
    return uvec2(p.x | (p.y << 21), (p.y >> 11) | (p.z << 10));
}

vec3 unpackPower(uvec2 bits) {
    return vec3(bits.x & 0x1FFFFFu, (bits.x >> 21) | ((bits.y & 0x3FFu) << 11), bits.y >> 10);
}

#endif
