#version 460
#extension GL_EXT_scalar_block_layout : require
// Samples the volume whose number each position names, by a loop over all of them.
layout(local_size_x = 8) in;
layout(constant_id = 0) const int VOLUMES = 1;

layout(binding = 0) uniform sampler3D volumes[VOLUMES];
layout(scalar, binding = 1) readonly buffer Positions { vec4 positions[]; };  // the fourth: number of a volume
layout(scalar, binding = 2) writeonly buffer Values { float values[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    const int wanted = int(positions[i].w);
    float value = -1.0;
    for (int volume = 0; volume < VOLUMES; ++volume)
        if (volume == wanted) value = textureLod(volumes[volume], positions[i].xyz, 0.0).x;
    values[i] = value;
}
