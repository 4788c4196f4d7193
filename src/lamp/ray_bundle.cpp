#include "lamp/ray_bundle.h"

#include <algorithm>
#include <cmath>

namespace lumulus::lamp {

namespace {

/// Parts of the rays that are halved once more.
constexpr int mostHalvings = 40;

struct Search {
    const Beam& beam;
    double off;
    const RayBundle& rays;

    bool mayMeet(double begin, double end, int halvings) const {
        const double half = 0.5 * (end - begin), at = begin + half, across = rays.widthAt(end) + off;
        const glm::dvec3 way = rays.middle.origin + at * rays.middle.direction - beam.position();
        const double away = glm::length(way), around = half + across;
        if (!(away > around)) {
            if (half <= across || halvings == 0) return true;
        } else {
            const double angle = std::acos(std::clamp(glm::dot(way, beam.direction()) / away, -1.0, 1.0));
            if (angle - std::asin(around / away) > beam.widest()) return false;
            if (half <= across || halvings == 0 || angle <= beam.widest()) return true;
        }
        return mayMeet(begin, at, halvings - 1) || mayMeet(at, end, halvings - 1);
    }
};

}  // namespace

bool mayLight(const Beam& beam, double off, const RayBundle& rays) {
    return beam.isPoint() || Search{beam, off, rays}.mayMeet(0.0, rays.end, mostHalvings);
}

double distanceTo(const RayBundle& rays, const glm::dvec3& point) {
    const glm::dvec3 way = point - rays.middle.origin;
    const double along = std::clamp(glm::dot(way, rays.middle.direction), 0.0, rays.end);
    return std::max(0.0, glm::length(way - along * rays.middle.direction) - rays.widthAt(along));
}

}  // namespace lumulus::lamp
