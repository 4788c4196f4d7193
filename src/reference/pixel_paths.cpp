#include "reference/pixel_paths.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtx/component_wise.hpp>

#include "reference/metrics.h"
#include "reference/random.h"
#include "scene/ephemeris.h"
#include "view/ground.h"

namespace lumulus::reference {
namespace {

std::vector<DiscCover> discsOf(const scene::Scene& scene, const AnyTracer& tracer, const Camera& camera) {
    std::vector<DiscCover> discs;
    if (!scene.image.background || !tracer.sunny()) return discs;
    const SunDisc& sun = tracer.sun();
    discs.emplace_back(camera, scene.sun.refraction ? scene::apparentDirection(scene.sun) : sun.direction(),
                       sun.radius());
    if (scene.moon.shines) discs.emplace_back(camera, scene.moon.directionTo, sun.radius());
    return discs;
}

}  // namespace

PixelPaths::PixelPaths(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes)
    : PixelPaths(scene, volumes, makeCamera(scene.camera, scene.image, boundsOf(volumes)), scene.image) {}

PixelPaths::PixelPaths(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, const Camera& camera,
                       const scene::Image& image)
    : camera_(camera),
      tracer_(groundedScene(scene, boundsOf(volumes)), volumes, Majorant::local),
      skyUnit_(scene.image.background ? tracer_.skyUnit() : glm::dvec3(0.0)),
      lamps_(scene, camera_),
      discs_(discsOf(scene, tracer_, camera_)),
      fog_(!scene.fog.media.empty()),
      width_(static_cast<std::size_t>(image.width)) {}

PixelSample PixelPaths::trace(std::size_t pixel, Random& random) const {
    const auto x = static_cast<int>(pixel % width_), y = static_cast<int>(pixel / width_);
    const double px = x + random.uniform(), py = y + random.uniform();
    const PathSample path = tracer_.trace(camera_.ray(px, py), random);
    PixelSample sample{path.radiance + path.passed * skyUnit_, path.lost, path.events};
    sample.radiance += lamps_.seen(tracer_, camera_, path, {x, y}, random);
    return sample;
}

std::vector<float> PixelPaths::opacity(const LayeredImage& picture) const {
    std::vector<float> opacity(picture.pixels(), 0.0F);
    for (const std::size_t pixel : cloudPixels(picture, picture))
        opacity[pixel] =
            1.0F - std::min({picture.layers.at("transmittance.R")[pixel], picture.layers.at("transmittance.G")[pixel],
                             picture.layers.at("transmittance.B")[pixel]});
    tbb::parallel_for(std::size_t{0}, opacity.size(), [&](std::size_t pixel) {
        const int x = static_cast<int>(pixel % width_), y = static_cast<int>(pixel / width_);
        if (std::ranges::any_of(discs_, [&](const DiscCover& disc) { return disc.find(x, y) != nullptr; })) {
            opacity[pixel] = 0.0F;
        } else if (fog_) {
            const RayIntegrals line = tracer_.integrate(camera_.ray(x + 0.5, y + 0.5));
            opacity[pixel] = std::max(opacity[pixel], static_cast<float>(1.0 - glm::compMin(line.transmittance)));
        }
    });
    return opacity;
}

std::vector<std::size_t> countedPixels(const std::vector<float>& opacity) {
    constexpr float least = 1e-3F;
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < opacity.size(); ++i)
        if (opacity[i] > least) pixels.push_back(i);
    return pixels;
}

}  // namespace lumulus::reference
