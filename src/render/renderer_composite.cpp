// Pictures of other renderers, seen through the fog of the scene.
#include <algorithm>

#include "fog/screen/depth.h"
#include "render/renderer_state.h"

namespace lumulus {

LayeredImage Renderer::throughFog(const View& view, LayeredImage picture, std::vector<float> depth) {
    State& s = *state_;
    if (!s.fog) return picture;
    const Camera camera = makeCamera(view, s.bounds);
    fog::depthToDistance(depth, s.scene.fog, camera);
    fog::Layer layer{std::vector<glm::vec4>(picture.pixels(), glm::vec4(1.0F)), std::move(depth)};
    const char* names[3] = {"R", "G", "B"};
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<float>& values = picture.layers.at(names[channel]);
        for (std::size_t i = 0; i < values.size(); ++i) layer.radiance[i][channel] = std::max(0.0F, values[i]);
    }
    const std::vector<glm::vec4> seen = s.fog->apply(layer, camera);
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<float>& values = picture.layers.at(names[channel]);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = seen[i][channel];
    }
    return picture;
}

}  // namespace lumulus
