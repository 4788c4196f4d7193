// What is left of light from which more is taken than there is, where the parts that are taken are found in different ways.
#ifndef LUMULUS_LIB_TAKEN_LIGHT
#define LUMULUS_LIB_TAKEN_LIGHT

/// The difference, as long as some of the light is left; never black.
vec3 leftOf(vec3 light, vec3 taken) {
    const vec3 share = taken / max(light, 1.0e-20);
    return mix(light - taken, 0.3 * light * exp((0.7 - share) / 0.3), greaterThan(share, vec3(0.7)));
}

#endif
