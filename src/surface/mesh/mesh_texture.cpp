#include "surface/mesh/mesh_texture.h"

#include <algorithm>
#include <cmath>

namespace lumulus::surface {
namespace {

/// The pixel that stands at a place beyond the picture too.
std::size_t held(float place, int size, mesh::Wrap wrap) {
    const auto length = static_cast<float>(size);
    if (wrap == mesh::Wrap::repeat) place -= std::floor(place / length) * length;
    if (wrap == mesh::Wrap::mirror) {
        place -= std::floor(place / (2.0F * length)) * (2.0F * length);
        if (place >= length) place = 2.0F * length - 1.0F - place;
    }
    return static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, size - 1));
}

float toLinear(float value) {
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

glm::vec4 texelAt(const mesh::Texture& texture, float x, float y, bool srgb) {
    const auto& texel =
        texture.texels[held(y, texture.height, texture.wrapV) * static_cast<std::size_t>(texture.width) +
                       held(x, texture.width, texture.wrapU)];
    glm::vec4 value = glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0F;
    if (srgb) value = glm::vec4(toLinear(value.r), toLinear(value.g), toLinear(value.b), value.a);
    return value;
}

}  // namespace

glm::vec4 sampleTexture(const mesh::Texture& texture, const glm::vec2& uv, bool srgb) {
    constexpr float farthest = 1e5F;  // repeats, beyond which floats have no digits left
    const glm::vec2 place = glm::clamp(uv, -farthest, farthest) * glm::vec2(texture.width, texture.height) - 0.5F;
    const glm::vec2 first = glm::floor(place), rest = place - first;
    const glm::vec4 upper =
        glm::mix(texelAt(texture, first.x, first.y, srgb), texelAt(texture, first.x + 1.0F, first.y, srgb), rest.x);
    const glm::vec4 lower = glm::mix(texelAt(texture, first.x, first.y + 1.0F, srgb),
                                     texelAt(texture, first.x + 1.0F, first.y + 1.0F, srgb), rest.x);
    return glm::mix(upper, lower, rest.y);
}

}  // namespace lumulus::surface
