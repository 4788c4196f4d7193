#include "reference/mesh_texture.h"

#include <cmath>

namespace lumulus::reference {
namespace {

int wrapped(long place, int size, mesh::Wrap wrap) {
    const long length = size;
    if (wrap == mesh::Wrap::clamp) return static_cast<int>(std::min(std::max(place, 0L), length - 1));
    const long period = wrap == mesh::Wrap::mirror ? 2 * length : length;
    const long in = ((place % period) + period) % period;
    return static_cast<int>(in < length ? in : period - 1 - in);
}

double linear(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace

glm::dvec4 textureAt(const mesh::Texture& texture, const glm::dvec2& uv, bool srgb) {
    // places beyond a million repeats have no digits left
    const glm::dvec2 within = glm::clamp(uv, -1e6, 1e6) * glm::dvec2(texture.width, texture.height) - 0.5;
    const glm::dvec2 corner = glm::floor(within), share = within - corner;
    glm::dvec4 sum(0.0);
    for (int i = 0; i < 4; ++i) {
        const int x = wrapped(static_cast<long>(corner.x) + i % 2, texture.width, texture.wrapU);
        const int y = wrapped(static_cast<long>(corner.y) + i / 2, texture.height, texture.wrapV);
        const auto& texel = texture.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(texture.width) +
                                           static_cast<std::size_t>(x)];
        glm::dvec4 value(texel[0], texel[1], texel[2], texel[3]);
        value /= 255.0;
        if (srgb)
            for (int channel = 0; channel < 3; ++channel) value[channel] = linear(value[channel]);
        sum += value * (i % 2 != 0 ? share.x : 1.0 - share.x) * (i / 2 != 0 ? share.y : 1.0 - share.y);
    }
    return sum;
}

bool isThere(const mesh::Model& model, const mesh::Material& material, const glm::dvec2& uv) {
    if (!material.masked()) return true;
    double alpha = static_cast<double>(material.alpha);
    if (material.colourTexture >= 0)
        alpha *= textureAt(model.textures[static_cast<std::size_t>(material.colourTexture)], uv, true).a;
    return alpha >= static_cast<double>(material.alphaCutoff);
}

}  // namespace lumulus::reference
