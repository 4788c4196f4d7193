#include "reference/lamp_covers.h"

#include <algorithm>
#include <cmath>

namespace lumulus::reference {

LampCovers::LampCovers(const scene::Scene& scene, const Camera& camera) {
    for (const scene::Lamp& lamp : scene.lamps) {
        if (!lamp.shines() || camera.projection == scene::Projection::orthographic) continue;
        const glm::dvec3 way = lamp.position - camera.position;
        const double distance = glm::length(way);
        covers_.emplace_back(camera, way / distance, std::asin(std::min(1.0, lamp.radius / distance)));
    }
}

glm::dvec3 LampCovers::seen(const AnyTracer& tracer, const Camera& camera, const PathSample& path,
                            const glm::ivec2& pixel, Random& random) const {
    if (covers_.empty()) return path.lamps;
    glm::dvec3 light(0.0);
    for (std::size_t lamp = 0; lamp < covers_.size(); ++lamp) {
        const DiscCover::Pixel* covered = covers_[lamp].find(pixel.x, pixel.y);
        if (covered == nullptr) continue;
        const glm::dvec2 place = covered->sample(random);
        light += covered->share * tracer.lampSeen(camera.ray(place.x, place.y), lamp);
    }
    return light;
}

}  // namespace lumulus::reference
