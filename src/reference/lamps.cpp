#include "reference/lamps.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/phase.h"

namespace lumulus::reference {
namespace {

/// 1 − cos of half the angle at which a sphere is seen from outside.
double coneOf(double radius, double distance) {
    const double sine = radius / distance;
    return sine * sine / (1.0 + std::sqrt((1.0 - sine) * (1.0 + sine)));
}

double densityIn(double oneMinusCos) {
    return 1.0 / (glm::two_pi<double>() * oneMinusCos);
}

}  // namespace

std::vector<scene::Surface> withLamps(std::vector<scene::Surface> surfaces, const std::vector<scene::Lamp>& lamps) {
    for (const scene::Lamp& lamp : lamps) {
        if (!lamp.shines()) continue;
        scene::Surface& sphere = surfaces.emplace_back();
        sphere.kind = scene::SurfaceKind::sphere;
        sphere.position = lamp.position;
        sphere.radius = lamp.radius;
        sphere.albedo = glm::dvec3(0.0);
    }
    return surfaces;
}

Lamps::Lamps(const std::vector<scene::Surface>& surfaces, const std::vector<scene::Lamp>& lamps) : surfaces_(surfaces) {
    for (const scene::Lamp& lamp : lamps) {
        if (lamp.shines()) beams_.emplace_back(lamp);
    }
    firstBeam_ = surfaces.size() - beams_.size();
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const scene::Surface& s = surfaces[i];
        const double light = s.emission.x + s.emission.y + s.emission.z;
        if (s.kind != scene::SurfaceKind::sphere || !(light > 0.0)) continue;
        lamps_.push_back({i, s.position, s.radius, light * s.radius * s.radius, {}});
    }
    std::size_t surface = firstBeam_;
    for (const scene::Lamp& lamp : lamps) {
        if (!lamp.shines()) continue;
        const LampLight& beam = beams_[surface - firstBeam_];
        const double power = lamp.power.x + lamp.power.y + lamp.power.z;
        lamps_.push_back(
            {surface++, lamp.position, lamp.radius, power * beam.largestShare() * glm::one_over_pi<double>(), beam});
    }
}

/// Weight of the lamp in the choice. It is 0 inside the lamp, which paths meet by chance alone.
double Lamps::Lamp::weightAt(const glm::dvec3& point) const {
    const glm::dvec3 way = middle - point;
    const double square = glm::dot(way, way);
    if (!(square > radius * radius)) return 0.0;
    if (beam) {
        const double distance = std::sqrt(square);
        if (!beam->reaches(-way / distance, std::asin(radius / distance))) return 0.0;
    }
    return light / square;
}

double Lamps::weightAt(const glm::dvec3& point) const {
    double total = 0.0;
    for (const Lamp& lamp : lamps_) total += lamp.weightAt(point);
    return total;
}

std::optional<LampSample> Lamps::sample(const glm::dvec3& point, Random& random) const {
    const double total = weightAt(point);
    if (!(total > 0.0)) return std::nullopt;
    double left = total * random.uniform();
    for (const Lamp& lamp : lamps_) {
        const double weight = lamp.weightAt(point);
        left -= weight;
        if (left >= 0.0) continue;
        const glm::dvec3 way = lamp.middle - point;
        const double distance = glm::length(way);
        const double cone = coneOf(lamp.radius, distance);
        return LampSample{lamp.surface, turned(way / distance, cone * random.uniform(), random),
                          weight / total * densityIn(cone)};
    }
    return std::nullopt;
}

glm::dvec3 Lamps::emission(std::size_t surface, const glm::dvec3& direction) const {
    return surface < firstBeam_ ? surfaces_[surface].emission : beams_[surface - firstBeam_].radiance(direction);
}

double Lamps::density(const glm::dvec3& point, std::size_t surface) const {
    for (const Lamp& lamp : lamps_) {
        if (lamp.surface != surface) continue;
        const double weight = lamp.weightAt(point);
        if (weight == 0.0) return 0.0;
        return weight / weightAt(point) * densityIn(coneOf(lamp.radius, glm::distance(lamp.middle, point)));
    }
    return 0.0;
}

}  // namespace lumulus::reference
