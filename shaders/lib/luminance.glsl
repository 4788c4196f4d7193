// Rec. 709 luminance.
#ifndef LUMULUS_LIB_LUMINANCE
#define LUMULUS_LIB_LUMINANCE

float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

#endif
