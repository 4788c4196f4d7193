#include "reference/pixel_paths.h"

#include "reference/random.h"
#include "view/ground.h"

namespace lumulus::reference {

PixelPaths::PixelPaths(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes)
    : camera_(makeCamera(scene.camera, scene.image, boundsOf(volumes))),
      tracer_(groundedScene(scene, boundsOf(volumes)), volumes, Majorant::local),
      skyUnit_(scene.image.background ? tracer_.skyUnit() : glm::dvec3(0.0)),
      lamps_(scene, camera_),
      width_(static_cast<std::size_t>(scene.image.width)) {}

PixelSample PixelPaths::trace(std::size_t pixel, Random& random) const {
    const auto x = static_cast<int>(pixel % width_), y = static_cast<int>(pixel / width_);
    const double px = x + random.uniform(), py = y + random.uniform();
    const PathSample path = tracer_.trace(camera_.ray(px, py), random);
    PixelSample sample{path.radiance + path.passed * skyUnit_, path.lost, path.events};
    sample.radiance += lamps_.seen(tracer_, camera_, path, {x, y}, random);
    return sample;
}

}  // namespace lumulus::reference
