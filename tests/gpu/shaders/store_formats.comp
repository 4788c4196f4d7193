#version 460
layout(local_size_x = 1) in;

// One picture of each format, all of which get the same texels.
layout(binding = 0, r8) writeonly uniform image2D r8;
layout(binding = 1, r16f) writeonly uniform image2D r16f;
layout(binding = 2, r16ui) writeonly uniform uimage2D r16ui;
layout(binding = 3, r32f) writeonly uniform image2D r32f;
layout(binding = 4, r32ui) writeonly uniform uimage2D r32ui;
layout(binding = 5, rg16f) writeonly uniform image2D rg16f;
layout(binding = 6, rg32f) writeonly uniform image2D rg32f;
layout(binding = 7, rg32ui) writeonly uniform uimage2D rg32ui;
layout(binding = 8, rgba8) writeonly uniform image2D rgba8;
layout(binding = 9, r11f_g11f_b10f) writeonly uniform image2D r11f_g11f_b10f;
layout(binding = 10, rgba16f) writeonly uniform image2D rgba16f;
layout(binding = 11, rgba32f) writeonly uniform image2D rgba32f;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec4 value = vec4(1.0, 0.5, 0.25, 0.0);
    uvec4 whole = uvec4(40000u, 7u, 0u, 0u);
    imageStore(r8, at, value);
    imageStore(r16f, at, value);
    imageStore(r16ui, at, whole);
    imageStore(r32f, at, value);
    imageStore(r32ui, at, whole);
    imageStore(rg16f, at, value);
    imageStore(rg32f, at, value);
    imageStore(rg32ui, at, whole);
    imageStore(rgba8, at, value);
    imageStore(r11f_g11f_b10f, at, value);
    imageStore(rgba16f, at, value);
    imageStore(rgba32f, at, value);
}
