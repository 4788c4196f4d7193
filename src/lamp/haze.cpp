#include "lamp/haze.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "medium/fog_media.h"

namespace lumulus::lamp {

/// For the closed forms of shared/fog.h.
struct Haze::Media {
    std::vector<shared::FogMedium> all;
};

Haze::Haze(const scene::Fog& fog, const glm::dvec3& eye)
    : fog_(fog), eye_(eye), media_(std::make_unique<const Media>(fog::mediaAround(fog, eye))) {}

Haze::~Haze() = default;

glm::dvec3 Haze::depth(const Ray& ray, double metres) const {
    const glm::vec3 origin(ray.origin - eye_), direction(ray.direction);
    const auto distance = static_cast<float>(std::min(metres, 1e30)), sky = static_cast<float>(fog_.skyDistance);
    glm::vec3 sum(0.0F);
    for (const shared::FogMedium& medium : media_->all)
        sum +=
            (medium.scattering + medium.absorption) * shared::densityIntegral(medium, origin, direction, distance, sky);
    return glm::dvec3(sum);
}

double Haze::densityAt(const scene::FogMedium& medium, const glm::dvec3& point) const {
    const glm::dvec3 off = point - medium.center;
    switch (medium.kind) {
        case scene::MediumKind::sphere:
            return std::max(0.0, 1.0 - glm::dot(off, off) / (medium.radius * medium.radius));
        case scene::MediumKind::ellipsoid:
            return glm::length(off / medium.halfSize) <= 1.0 ? 1.0 : 0.0;
        case scene::MediumKind::box:
            return glm::all(glm::lessThanEqual(glm::abs(off), medium.halfSize)) ? 1.0 : 0.0;
        case scene::MediumKind::homogeneous:
        case scene::MediumKind::exponential:
            break;
    }
    if (point.y < medium.bottom || point.y > medium.top) return 0.0;
    if (medium.kind == scene::MediumKind::homogeneous) return 1.0;
    return std::exp(std::min(80.0, -medium.falloff * glm::dot(point - medium.offset, medium.direction)));
}

glm::dvec3 Haze::turned(const glm::dvec3& point, double cosine) const {
    glm::dvec3 sum(0.0);
    for (const scene::FogMedium& medium : fog_.media)
        sum += medium.scattering * (densityAt(medium, point) * phase(medium.g, cosine));
    return sum;
}

glm::dvec3 Haze::scattering(const glm::dvec3& point) const {
    glm::dvec3 sum(0.0);
    for (const scene::FogMedium& medium : fog_.media) sum += medium.scattering * densityAt(medium, point);
    return sum;
}

glm::dvec3 Haze::extinction(const glm::dvec3& point) const {
    glm::dvec3 sum(0.0);
    for (const scene::FogMedium& medium : fog_.media)
        sum += (medium.scattering + medium.absorption) * densityAt(medium, point);
    return sum;
}

double Haze::meanCosine(const glm::dvec3& point, double u) const {
    const glm::dvec3 all = scattering(point);
    double left = u * (all.x + all.y + all.z), g = 0.0;
    for (const scene::FogMedium& medium : fog_.media) {
        const double weight =
            (medium.scattering.x + medium.scattering.y + medium.scattering.z) * densityAt(medium, point);
        if (!(weight > 0.0)) continue;
        g = medium.g;
        left -= weight;
        if (left < 0.0) break;
    }
    return g;
}

void Haze::addCorners(const Ray& ray, std::vector<double>& distances) const {
    const auto addPlane = [&](int axis, double place) {
        if (std::isfinite(place) && ray.direction[axis] != 0.0)
            distances.push_back((place - ray.origin[axis]) / ray.direction[axis]);
    };
    for (const scene::FogMedium& medium : fog_.media) {
        const bool ball = medium.kind == scene::MediumKind::sphere;
        if (ball || medium.kind == scene::MediumKind::ellipsoid) {
            const glm::dvec3 size = ball ? glm::dvec3(medium.radius) : medium.halfSize;
            const glm::dvec3 from = (ray.origin - medium.center) / size, along = ray.direction / size;
            const double a = glm::dot(along, along), b = glm::dot(from, along), c = glm::dot(from, from) - 1.0;
            if (b * b <= a * c) continue;
            const double root = std::sqrt(b * b - a * c);
            distances.insert(distances.end(), {(-b - root) / a, (-b + root) / a});
        } else if (medium.kind == scene::MediumKind::box) {
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {-1.0, 1.0})
                    addPlane(axis, medium.center[axis] + side * medium.halfSize[axis]);
        } else {
            addPlane(1, medium.bottom);
            addPlane(1, medium.top);
        }
    }
}

double phase(double g, double cosine) {
    const double away = std::max(1.0 + g * g - 2.0 * g * cosine, 1e-12);
    return 0.25 * std::numbers::inv_pi * (1.0 - g * g) / (away * std::sqrt(away));
}

}  // namespace lumulus::lamp
