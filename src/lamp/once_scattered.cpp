#include "lamp/once_scattered.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumulus::lamp {

namespace {

/// Beyond it in u there is less than e^−10 of what there may be.
constexpr double farthest = 10.0;
/// Width of the panels of the rule in u; where the light of a lamp fades towards the sides, there are more, and where
/// clouds throw shadows, still more.
constexpr double panel = 1.25, fadingPanel = 0.5, shadedPanel = 0.2;
/// Optical depth at which nothing of the light is left.
constexpr double opaque = 40.0;

constexpr std::array<double, 3> nodes{-0.7745966692414834, 0.0, 0.7745966692414834};
constexpr std::array<double, 3> weights{0.5555555555555556, 0.8888888888888889, 0.5555555555555556};

/// A ray beside a lamp.
struct Passing {
    const Haze& haze;
    const Beam& beam;
    const Ray& ray;
    double nearest;  ///< along the ray
    double miss;

    double uOf(double distance) const {
        return std::clamp(std::asinh((distance - nearest) / miss), -farthest, farthest);
    }
    double distanceOf(double u) const { return nearest + miss * std::sinh(u); }

    bool isLit(double distance) const {
        const glm::dvec3 point = ray.origin + distance * ray.direction;
        return beam.share(glm::normalize(point - beam.position())) > 0.0 && haze.scattering(point) != glm::dvec3(0.0);
    }

    /// What a step of one in u adds at u.
    glm::dvec3 at(double u) const {
        const double up = std::exp(u), down = 1.0 / up, sinh = 0.5 * (up - down), cosh = 0.5 * (up + down);
        const double away = miss * cosh, distance = nearest + miss * sinh;
        const glm::dvec3 point = ray.origin + distance * ray.direction;
        const glm::dvec3 travel = glm::normalize(point - beam.position());
        const double share = beam.share(travel);
        if (!(share > 0.0)) return glm::dvec3(0.0);
        const glm::dvec3 depth = haze.depth(ray, distance) + haze.depth({point, -travel}, away);
        return haze.turned(point, -sinh / cosh) * glm::exp(-depth) * (share / away * beam.passed(travel, away));
    }
};

}  // namespace

double missOf(const Ray& ray, const glm::dvec3& point) {
    return glm::length(glm::cross(point - ray.origin, ray.direction));
}

glm::dvec3 onceScattered(const Haze& haze, const Beam& beam, const Ray& ray, const Part& part, double miss) {
    thread_local std::vector<double> corners;  // no allocation a ray
    const Passing passing{haze, beam, ray, glm::dot(beam.position() - ray.origin, ray.direction),
                          std::max(miss, beam.radius())};
    corners.assign({part.begin, part.end});
    beam.addCorners(ray, corners);
    haze.addCorners(ray, corners);
    std::ranges::sort(corners);
    const double width = beam.isShaded() ? shadedPanel : (beam.isPoint() ? panel : fadingPanel);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const double from = std::max(corners[i], part.begin), to = std::min(corners[i + 1], part.end);
        if (!(from < to)) continue;
        const double first = passing.uOf(from), last = passing.uOf(to);
        if (!(first < last) || !passing.isLit(passing.distanceOf(0.5 * (first + last)))) continue;
        const int panels = static_cast<int>(std::ceil((last - first) / width));
        const double half = 0.5 * (last - first) / panels;
        for (int k = 0; k < panels; ++k) {
            const double middle = first + (2 * k + 1) * half;
            if (haze.depth(ray, passing.distanceOf(middle - half)).y > opaque) break;
            for (std::size_t n = 0; n < nodes.size(); ++n)
                sum += weights[n] * half * passing.at(middle + nodes[n] * half);
        }
    }
    return sum * beam.power();
}

}  // namespace lumulus::lamp
