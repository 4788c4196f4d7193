#version 460
layout(local_size_x = 1) in;

// One sample at the centre of a picture.
layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) writeonly buffer Value { vec4 value; };
layout(push_constant) uniform Push { float level; };

void main() {
    value = textureLod(picture, vec2(0.5), level);
}
