#include "reference/pixel_paths.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <glm/gtx/component_wise.hpp>

#include "reference/metrics.h"
#include "reference/random.h"
#include "view/ground.h"

namespace lumulus::reference {

PixelPaths::PixelPaths(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes)
    : camera_(makeCamera(scene.camera, scene.image, boundsOf(volumes))),
      tracer_(groundedScene(scene, boundsOf(volumes)), volumes, Majorant::local),
      skyUnit_(scene.image.background ? tracer_.skyUnit() : glm::dvec3(0.0)),
      lamps_(scene, camera_),
      fog_(!scene.fog.media.empty()),
      width_(static_cast<std::size_t>(scene.image.width)) {}

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
    if (!fog_) return opacity;
    const auto disc = picture.layers.find("sun.disc");
    tbb::parallel_for(std::size_t{0}, opacity.size(), [&](std::size_t pixel) {
        if (disc != picture.layers.end() && disc->second[pixel] > 0.0F) return;
        const double px = static_cast<double>(pixel % width_) + 0.5, py = static_cast<double>(pixel / width_) + 0.5;
        const RayIntegrals line = tracer_.integrate(camera_.ray(px, py));
        opacity[pixel] = std::max(opacity[pixel], static_cast<float>(1.0 - glm::compMin(line.transmittance)));
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
