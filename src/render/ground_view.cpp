#include "render/ground_view.h"

#include <fmt/format.h>

#include "base/error.h"
#include "render/world_media.h"

namespace lumulus {

const surface::GroundLight& GroundView::light(gpu::Context& context, World& world, const Check& check) {
    const scene::Sun& sun = world.lights.sun;
    Cause cause{sun.directionTo, sun.irradiance, {}, {}};
    for (const std::size_t i : world.visible()) {
        cause.places.push_back(world.instances[i].origin + world.instances[i].offset);
        cause.extinctions.push_back(world.instances[i].medium.extinction);
    }
    if (!light_ || !(cause == cause_)) {
        light_.emplace(*world.lights.ground, mediaOf(context, world, check), sun, world.lights.constantSky(), check);
        cause_ = std::move(cause);
    }
    return *light_;
}

void requireAbove(const scene::Ground& ground, const Camera& camera) {
    if (camera.position.y < ground.height)
        throw InputError(
            fmt::format("the camera at y = {} m is below the ground at {} m", camera.position.y, ground.height),
            "camera.position", "raise the camera or lower ground.height");
}

std::vector<glm::vec4> groundThroughFog(fog::Fog& fog, const Camera& camera,
                                        const std::vector<surface::GroundPixel>& ground, const glm::dvec3& sky,
                                        const std::vector<shared::SunPixel>& sun) {
    fog::Layer layer;
    layer.radiance.reserve(ground.size());
    layer.distances.reserve(ground.size());
    for (const surface::GroundPixel& seen : ground) {
        layer.radiance.emplace_back(glm::mix(glm::vec3(sky), seen.radiance, seen.share), 1.0F);
        layer.distances.push_back(seen.share >= 0.5F ? seen.distance : shared::FAR_DEPTH);
    }
    for (const shared::SunPixel& pixel : sun)
        layer.radiance[static_cast<std::size_t>(pixel.pixel.y) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(pixel.pixel.x)] += glm::vec4(pixel.radiance, 0.0F);
    return fog.apply(layer, camera);
}

void layBehind(LayeredImage& image, const std::vector<glm::vec4>& behind, const Tile& part, int width) {
    constexpr const char* names[3] = {"R", "G", "B"};
    const std::vector<float>& passed = image.layer("transmittance.R");
    for (int c = 0; c < 3; ++c) {
        const std::vector<float>& cloud = image.layer(std::string("cloud.") + names[c]);
        std::vector<float>& seen = image.layer(names[c]);
        for (int y = 0; y < part.height; ++y)
            for (int x = 0; x < part.width; ++x) {
                const auto to =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x);
                const auto from = static_cast<std::size_t>(part.y + y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(part.x + x);
                seen[to] = cloud[to] + passed[to] * behind[from][c];
            }
    }
}

}  // namespace lumulus
