#include "fog/screen/frame.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "medium/fog_media.h"
#include "shared/fog.h"

namespace lumulus::fog {

namespace {

constexpr std::array<const char*, 3> colours{"R", "G", "B"};

std::array<std::vector<float>*, 3> rgbOf(LayeredImage& image, const std::string& prefix) {
    return {&image.layers.at(prefix + colours[0]), &image.layers.at(prefix + colours[1]),
            &image.layers.at(prefix + colours[2])};
}

/// The three layers of a frame.
struct FrameLayers {
    Layer cloud, shadow, bright;
    bool clouded = false, lit = false;
};

FrameLayers split(LayeredImage& image, const glm::vec3& sky) {
    const std::size_t count = image.pixels();
    const std::vector<float> far(count, shared::FAR_DEPTH);
    const std::vector<glm::vec4> black(count, glm::vec4(0.0F));
    FrameLayers layers{{black, image.layers.at("depth.Z")}, {black, far}, {black, far}};
    const auto both = rgbOf(image, ""), front = rgbOf(image, "cloud.");
    const std::vector<float>& cover = image.layers.at("A");
    for (std::size_t i = 0; i < count; ++i) {
        layers.cloud.radiance[i].w = cover[i];
        layers.clouded = layers.clouded || cover[i] > 0.0F;
        for (int c = 0; c < 3; ++c) {
            const auto channel = static_cast<std::size_t>(c);
            const float light = (*front[channel])[i], behind = (*both[channel])[i] - light - sky[c];
            layers.cloud.radiance[i][c] = light;
            layers.shadow.radiance[i][c] = std::max(-behind, 0.0F);
            layers.bright.radiance[i][c] = std::max(behind, 0.0F);
            layers.lit = layers.lit || behind > 0.0F;
        }
    }
    return layers;
}

/// A sky of the same radiance everywhere and the fog's own light where no cloud covers it, as seen through all fog.
std::vector<glm::vec3> uniformSky(const scene::Fog& fog, const Camera& camera, const glm::vec3& sky,
                                  const std::vector<float>& cover) {
    const std::vector<shared::FogMedium> media = mediaAround(fog, camera.position);
    std::vector<glm::vec3> seen(cover.size());
    tbb::parallel_for(0, camera.height, [&](int y) {
        for (int x = 0; x < camera.width; ++x) {
            const Ray ray = camera.ray(x + 0.5, y + 0.5);
            shared::FogPath path = shared::clearPath();
            for (const shared::FogMedium& medium : media) {
                shared::addMedium(
                    path, medium,
                    shared::densityIntegral(medium, glm::vec3(ray.origin - camera.position), glm::vec3(ray.direction),
                                            shared::FAR_DEPTH, static_cast<float>(fog.skyDistance)));
            }
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
            seen[i] = glm::exp(-path.absorption) * sky + (1.0F - cover[i]) * shared::emittedRadiance(path);
        }
    });
    return seen;
}

}  // namespace

void applyToFrame(Fog& fog, LayeredImage& image, const Camera& camera, const glm::dvec3& skyRadiance) {
    const glm::vec3 sky(skyRadiance);
    const FrameLayers layers = split(image, sky);
    const std::vector<glm::vec3> open = uniformSky(fog.scene(), camera, sky, image.layers.at("A"));
    const std::vector<glm::vec4> none(image.pixels(), glm::vec4(0.0F));
    const std::vector<glm::vec4> cloud = layers.clouded ? fog.apply(layers.cloud, camera) : none;
    const std::vector<glm::vec4> shadow = layers.clouded ? fog.apply(layers.shadow, camera) : none;
    const std::vector<glm::vec4> bright = layers.lit ? fog.apply(layers.bright, camera) : none;
    const auto both = rgbOf(image, ""), front = rgbOf(image, "cloud.");
    for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        for (std::size_t i = 0; i < open.size(); ++i) {
            // light of the sky cannot be less than none, wherever the cloud's blurred shadow falls
            const float behind = std::max(open[i][c] - shadow[i][c], 0.0F) + bright[i][c];
            (*front[channel])[i] = cloud[i][c];
            (*both[channel])[i] = cloud[i][c] + behind;
        }
    }
}

}  // namespace lumulus::fog
