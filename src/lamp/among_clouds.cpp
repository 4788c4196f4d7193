#include "lamp/among_clouds.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lumulus::lamp {

namespace {

/// Steps end where this share of the clouds' light could be left.
constexpr double opaque = 1e-4;
/// Length of a step over the distance from the nearest lamp, at most; steps between two corners.
constexpr double nearShare = 0.3, mostSteps = 4096.0, fewestSteps = 3.0;

/// (1 − e^−x)/x.
double meanPassed(double x) {
    return x < 1e-4 ? 1.0 - 0.5 * x : -std::expm1(-x) / x;
}

/// Where in a step of this optical depth the mean of its light comes from: 0 to 1.
double seenAt(double depth) {
    return depth < 1e-2 ? 0.5 - depth / 12.0 : 1.0 / depth - 1.0 / std::expm1(depth);
}

/// A ray within clouds.
struct March {
    const Around& around;
    std::span<const PassedBeam> beams;
    const Ray& ray;
    std::vector<CloudPart> parts;  ///< in the order of their beginnings
    std::vector<double> depths;    ///< of each part, in the step
    std::vector<double> corners;
    SeenAmongClouds seen;

    double stepAt(double begin) const {
        double step = around.clouds.finestVoxel();
        for (const PassedBeam& passed : beams) {
            const double along = begin - glm::dot(passed.beam->position() - ray.origin, ray.direction);
            const double away = std::hypot(along, std::max(passed.miss, passed.beam->radius()));
            step = std::min(step, std::max(nearShare * away, 1e-3 * step));
        }
        return step;
    }

    /// Light of one lamp that arrives at a point of the ray [W/m²], and the direction in which it travels, both as they
    /// are where a ray passes the lamp at `passed.miss`.
    glm::dvec3 arriving(const PassedBeam& passed, double at, glm::dvec3& travel) const {
        const glm::dvec3 point = ray.origin + at * ray.direction, way = point - passed.beam->position();
        const double along = glm::dot(way, ray.direction), away = glm::length(way);
        const double miss = std::max(passed.miss, passed.beam->radius());
        const glm::dvec3 direction = away > 0.0 ? way / away : ray.direction;
        const glm::dvec3 intensity = passed.beam->intensity(direction);
        if (intensity == glm::dvec3(0.0)) return intensity;
        const double clear = passed.beam->passed(direction, away);
        if (!(clear > 0.0)) return glm::dvec3(0.0);
        const glm::dvec3 fog =
            around.haze.isClear() ? glm::dvec3(1.0) : glm::exp(-around.haze.depth({point, -direction}, away));
        const glm::dvec3 across = way - along * ray.direction;
        const double length = glm::length(across);
        travel = length > 0.0 ? glm::normalize(miss / length * across + along * ray.direction) : direction;
        return intensity * fog * (clear / (miss * miss + along * along));
    }

    void addStep(double begin, double end, double depth) {
        const double at = begin + seenAt(depth) * (end - begin), each = meanPassed(depth);
        const glm::dvec3 point = ray.origin + at * ray.direction;
        const bool clear = around.haze.isClear();
        const glm::dvec3 before = seen.clear * (clear ? glm::dvec3(1.0) : glm::exp(-around.haze.depth(ray, at)));
        for (const PassedBeam& passed : beams) {
            glm::dvec3 travel;
            const glm::dvec3 light = arriving(passed, at, travel);
            if (light == glm::dvec3(0.0)) continue;
            glm::dvec3 scattered(0.0);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                if (!(depths[i] > 0.0)) continue;
                const Cloud& cloud = around.clouds[parts[i].cloud];
                scattered += cloud.albedo * cloud.phase.between(travel, -ray.direction) * depths[i];
            }
            if (!clear) scattered += around.haze.turned(point, -glm::dot(travel, ray.direction)) * (end - begin);
            seen.light += before * light * scattered * each;
        }
        seen.clear *= std::exp(-depth);
    }

    /// From one distance to another, between which clouds may be everywhere, and the sides of beams.
    void goThroughClouds(double begin, double end) {
        corners.assign({begin, end});
        for (const PassedBeam& passed : beams) passed.beam->addCorners(ray, corners);
        std::ranges::sort(corners);
        for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
            const double from = std::max(corners[i], begin), to = std::min(corners[i + 1], end);
            if (from < to) go(from, to);
        }
    }

    void go(double begin, double end) {
        const double least = (end - begin) / mostSteps, most = (end - begin) / fewestSteps;
        while (begin < end && seen.clear > opaque) {
            double next = std::min(end, begin + std::clamp(stepAt(begin), least, most));
            if (end - next < 1e-6 * (end - begin)) next = end;
            double depth = 0.0;
            for (std::size_t i = 0; i < parts.size(); ++i) {
                const bool meets = parts[i].begin < next && parts[i].end > begin;
                depths[i] = meets ? around.clouds.depthOf(parts[i].cloud, ray, begin, next) : 0.0;
                depth += depths[i];
            }
            if (depth > 0.0 || !around.haze.isClear()) addStep(begin, next, depth);
            begin = next;
        }
    }

    /// From one distance to another, between which there is none.
    void goThroughFog(double begin, double end) {
        if (around.haze.isClear() || !(begin < end)) return;
        for (const PassedBeam& passed : beams)
            seen.light += seen.clear * onceScattered(around.haze, *passed.beam, ray, {begin, end}, passed.miss);
    }
};

}  // namespace

SeenAmongClouds scatteredAmongClouds(const Around& around, std::span<const PassedBeam> beams, const Ray& ray,
                                     double metres) {
    March march{around, beams, ray, {}, {}, {}, {}};
    around.clouds.addParts(ray, metres, march.parts);
    std::ranges::sort(march.parts, {}, &CloudPart::begin);
    march.depths.resize(march.parts.size());
    double reached = 0.0;
    for (std::size_t i = 0; i < march.parts.size() && march.seen.clear > opaque;) {
        const double begin = march.parts[i].begin;
        double end = march.parts[i].end;
        for (++i; i < march.parts.size() && march.parts[i].begin < end; ++i) end = std::max(end, march.parts[i].end);
        march.goThroughFog(reached, begin);
        march.goThroughClouds(begin, end);
        reached = end;
    }
    if (march.seen.clear > opaque)
        march.goThroughFog(reached, metres);
    else
        march.seen.clear = 0.0;
    return march.seen;
}

}  // namespace lumulus::lamp
