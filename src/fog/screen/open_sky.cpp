#include "fog/screen/open_sky.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "medium/fog_media.h"
#include "shared/fog.h"

namespace lumulus::fog {

namespace {

shared::FogPath pathThroughAll(const std::vector<shared::FogMedium>& media, const Ray& ray, const glm::dvec3& eye,
                               double skyDistance) {
    shared::FogPath path = shared::clearPath();
    for (const shared::FogMedium& medium : media)
        shared::addMedium(path, medium,
                          shared::densityIntegral(medium, glm::vec3(ray.origin - eye), glm::vec3(ray.direction),
                                                  shared::FAR_DEPTH, static_cast<float>(skyDistance)));
    return path;
}

}  // namespace

OpenSky openSky(const scene::Fog& fog, const Camera& camera, const glm::vec3& sky, const Tile& part) {
    const std::vector<shared::FogMedium> media = mediaAround(fog, camera.position);
    const glm::vec3 none(0.0F);
    const bool absorbs = std::ranges::any_of(media, [&](const auto& medium) { return medium.absorption != none; });
    const bool emits = std::ranges::any_of(media, [&](const auto& medium) { return medium.emission != none; });
    const std::size_t pixels = static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height);
    OpenSky seen{std::vector<glm::vec4>(absorbs ? pixels : 1, glm::vec4(sky, 1.0F)),
                 std::vector<glm::vec4>(emits ? pixels : 1, glm::vec4(0.0F))};
    if (!absorbs && !emits) return seen;
    tbb::parallel_for(0, part.height, [&](int y) {
        for (int x = 0; x < part.width; ++x) {
            const Ray ray = camera.ray(part.x + x + 0.5, part.y + y + 0.5);
            const shared::FogPath path = pathThroughAll(media, ray, camera.position, fog.skyDistance);
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x);
            if (absorbs) seen.sky[i] = glm::vec4(glm::exp(-path.absorption) * sky, 1.0F);
            if (emits) seen.own[i] = glm::vec4(shared::emittedRadiance(path), 1.0F);
        }
    });
    return seen;
}

}  // namespace lumulus::fog
