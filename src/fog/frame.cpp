#include "fog/frame.h"

#include <algorithm>
#include <array>

#include "shared/draw.h"

namespace lumulus::fog {

namespace {

constexpr std::array<const char*, 3> colours{"R", "G", "B"};

}  // namespace

void applyToFrame(Fog& fog, LayeredImage& image, const Camera& camera) {
    const std::size_t count = image.pixels();
    const std::vector<float>& cover = image.layers.at("A");
    Layer cloud{std::vector<glm::vec4>(count), image.layers.at("depth.Z")};
    Layer sky{std::vector<glm::vec4>(count), std::vector<float>(count, shared::FAR_DEPTH)};
    for (std::size_t i = 0; i < count; ++i) {
        cloud.radiance[i].w = cover[i];
        sky.radiance[i].w = 1.0F - cover[i];
    }
    for (int c = 0; c < 3; ++c) {
        const std::string name = colours[static_cast<std::size_t>(c)];
        const std::vector<float>& both = image.layers.at(name);
        const std::vector<float>& front = image.layers.at("cloud." + name);
        for (std::size_t i = 0; i < count; ++i) {
            cloud.radiance[i][c] = front[i];
            sky.radiance[i][c] = std::max(both[i] - front[i], 0.0F);
        }
    }
    const bool clouded = std::ranges::any_of(cover, [](float a) { return a > 0.0F; });
    const std::vector<glm::vec4> behind = fog.apply(sky, camera);
    const std::vector<glm::vec4> before =
        clouded ? fog.apply(cloud, camera) : std::vector<glm::vec4>(count, glm::vec4(0.0F));
    for (int c = 0; c < 3; ++c) {
        const std::string name = colours[static_cast<std::size_t>(c)];
        std::vector<float>& both = image.layers.at(name);
        std::vector<float>& front = image.layers.at("cloud." + name);
        for (std::size_t i = 0; i < count; ++i) {
            front[i] = before[i][c];
            both[i] = before[i][c] + behind[i][c];
        }
    }
}

}  // namespace lumulus::fog
