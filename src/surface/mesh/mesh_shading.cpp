#include "surface/mesh/mesh_shading.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface/mesh/normal_axes.h"

namespace lumulus::surface {
namespace {

using std::numbers::pi;

constexpr std::size_t together = std::size_t{1} << 18U;  ///< rays at once

/// A number in [0,1) for a pixel and a purpose.
double scattered(std::uint32_t pixel, std::uint32_t purpose) {
    std::uint32_t h = pixel * 0x9E3779B1U ^ (purpose + 1U) * 0x85EBCA77U;
    h = (h ^ (h >> 16U)) * 0x7FEB352DU;
    h = (h ^ (h >> 15U)) * 0x846CA68BU;
    return static_cast<double>(h ^ (h >> 16U)) * 0x1p-32;
}

/// Well-spread points of the unit square, shifted from pixel to pixel.
glm::dvec2 spread(const MeshSample& sample, std::uint32_t i, std::uint32_t purpose) {
    const glm::dvec2 point = material::spreadPoint(i, sample.directions);
    return glm::fract(point +
                      glm::dvec2(scattered(sample.pixel, 2 * purpose), scattered(sample.pixel, 2 * purpose + 1)));
}

/// A direction into the disc of the sun.
glm::dvec3 towardsDisc(const MeshLight& light, const glm::dvec2& u) {
    const double away = std::sin(light.sunRadius) * std::sqrt(u.x), turn = 2.0 * pi * u.y;
    return NormalAxes(light.toSun).outOf({away * std::cos(turn), away * std::sin(turn), std::sqrt(1.0 - away * away)});
}

std::uint32_t countOf(const MeshSample& sample) {
    return (sample.directions - sample.first + sample.step - 1) / sample.step;
}

}  // namespace

/// A direction of a sample.
struct MeshShading::Gathered {
    std::size_t sample = 0;
    glm::dvec3 direction{0.0};
    glm::dvec3 weight{0.0};  ///< of the radiance from there
    double density = 0.0;
};

shared::MeshRay MeshShading::rayFrom(const MeshPoint& point, const glm::dvec3& direction) const {
    const glm::dvec3 place = point.position - scene_.world.middle;
    // as far off the triangle as floats round
    const double off = 1e-6 * std::max(glm::length(place), 1e-2 * static_cast<double>(scene_.world.reach()));
    return {
        glm::vec3(place + off * point.faceNormal), 0.0F, glm::vec3(direction), 3e38F, point.instance, point.triangle};
}

glm::dvec3 MeshShading::around(const glm::dvec3& direction, double density, std::uint32_t directions) const {
    const double texel = 4.0 * pi / (6.0 * light_.around.size() * light_.around.size());
    const double level = 0.5 * std::log2(1.0 / (directions * density * texel));
    return glm::dvec3(light_.around.at(glm::vec3(direction), static_cast<float>(level)));
}

/// Light of the sun at each sample, towards the eye.
std::vector<glm::dvec3> MeshShading::sunlight(std::span<const MeshSample> samples, const RunGpu& run,
                                              const Check& check) {
    std::vector<glm::dvec3> points, result(samples.size(), glm::dvec3(0.0));
    std::vector<std::size_t> facing;
    std::vector<glm::dvec3> reflected;
    std::vector<shared::MeshRay> rays;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const MeshSample& sample = samples[i];
        const glm::dvec3 toSun =
            towardsDisc(light_, spread(sample, sample.first * (sample.directions / sample.step), 1));
        if (!(glm::dot(toSun, sample.point.faceNormal) > 0.0)) continue;
        const NormalAxes axes(sample.point.normal);
        const glm::dvec3 share =
            material::Reflection(sample.point.material, energy_).reflected(axes.into(sample.toEye), axes.into(toSun));
        if (share == glm::dvec3(0.0)) continue;
        facing.push_back(i);
        reflected.push_back(share);
        points.push_back(sample.point.position);
        rays.push_back(rayFrom(sample.point, toSun));
    }
    const std::vector<glm::dvec3> irradiance = light_.sun.at(points);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (irradiance[i] == glm::dvec3(0.0)) rays[i].most = -1.0F;
    const std::vector<bool> blocked = tracer_.blocked(rays, run, check);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (!blocked[i]) result[facing[i]] = reflected[i] * irradiance[i];
    return result;
}

/// Light of the surroundings that reaches a point seen by another one, by one direction.
glm::dvec3 MeshShading::beyond(const MeshSample& sample) const {
    const NormalAxes axes(sample.point.normal);
    const material::Reflection reflection(sample.point.material, energy_);
    const glm::dvec3 view = axes.into(sample.toEye);
    const material::LightSample drawn = reflection.sample(view, spread(sample, sample.first, 3));
    const glm::dvec3 direction = axes.outOf(drawn.light);
    if (!(drawn.density > 0.0) || !(glm::dot(direction, sample.point.faceNormal) > 0.0)) return glm::dvec3(0.0);
    return reflection.reflected(view, drawn.light) / drawn.density * around(direction, drawn.density, 4);
}

/// Adds the light of all directions but that of the sun.
void MeshShading::gather(std::span<const MeshSample> samples, std::vector<glm::dvec3>& radiance, const RunGpu& run,
                         const Check& check) {
    std::vector<std::size_t> starts(samples.size() + 1, 0);
    for (std::size_t i = 0; i < samples.size(); ++i) starts[i + 1] = starts[i] + countOf(samples[i]);
    std::vector<Gathered> ways(starts.back());
    std::vector<shared::MeshRay> rays(starts.back());
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
        const MeshSample& sample = samples[i];
        const NormalAxes axes(sample.point.normal);
        const material::Reflection reflection(sample.point.material, energy_);
        const glm::dvec3 view = axes.into(sample.toEye);
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k) {
            const std::uint32_t number = sample.first + static_cast<std::uint32_t>(k - starts[i]) * sample.step;
            const material::LightSample drawn = reflection.sample(view, spread(sample, number, 2));
            const glm::dvec3 direction = axes.outOf(drawn.light);
            rays[k] = rayFrom(sample.point, direction);
            const bool outside = drawn.density > 0.0 && glm::dot(direction, sample.point.faceNormal) > 0.0;
            if (!outside) {
                rays[k].most = -1.0F;
                continue;
            }
            ways[k] = {i, direction,
                       reflection.reflected(view, drawn.light) /
                           (drawn.density * static_cast<double>(starts[i + 1] - starts[i])),
                       drawn.density};
        }
    });
    const std::vector<shared::MeshHit> hits = tracer_.nearest(rays, run, check);
    std::vector<MeshSample> met;
    std::vector<std::size_t> metBy;
    for (std::size_t k = 0; k < ways.size(); ++k) {
        const Gathered& way = ways[k];
        if (!(way.density > 0.0)) continue;
        if (hits[k].instance < 0) {
            radiance[way.sample] += way.weight * around(way.direction, way.density, samples[way.sample].directions);
            continue;
        }
        MeshPoint point = scene_.at(hits[k], way.direction);
        // a glint that few rays meet would be a speck: its lobe becomes as wide as what a ray stands for
        const double stands = 1.0 / (samples[way.sample].directions * way.density);
        point.material.alpha = std::clamp(std::sqrt(stands), point.material.alpha, 1.0);
        met.push_back({point, -way.direction, samples[way.sample].pixel,
                       static_cast<std::uint32_t>(k - starts[way.sample]), samples[way.sample].directions,
                       samples[way.sample].directions});
        metBy.push_back(k);
    }
    const std::vector<glm::dvec3> lit = sunlight(met, run, check);
    for (std::size_t i = 0; i < met.size(); ++i)
        radiance[ways[metBy[i]].sample] += ways[metBy[i]].weight * (met[i].point.emission + lit[i] + beyond(met[i]));
    addLamps(met, [&](std::size_t i, const glm::dvec3& lamps) {
        radiance[ways[metBy[i]].sample] += ways[metBy[i]].weight * lamps;
    });
}

/// Tells of the light of lamps at each sample.
template <class Add>
void MeshShading::addLamps(std::span<const MeshSample> samples, const Add& add) const {
    if (!light_.lamps) return;
    std::vector<glm::dvec3> lit(samples.size());
    tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
        stopIfInterrupted();
        lit[i] = light_.lamps->at(samples[i].point, samples[i].toEye, energy_);
    });
    for (std::size_t i = 0; i < samples.size(); ++i) add(i, lit[i]);
}

std::vector<glm::dvec3> MeshShading::shade(std::span<const MeshSample> samples, const RunGpu& run, const Check& check) {
    std::vector<glm::dvec3> all;
    all.reserve(samples.size());
    std::size_t first = 0;
    while (first < samples.size()) {
        check();
        std::size_t end = first, rays = 0;
        while (end < samples.size() && (end == first || rays + countOf(samples[end]) <= together))
            rays += countOf(samples[end++]);
        const auto part = samples.subspan(first, end - first);
        std::vector<glm::dvec3> radiance = sunlight(part, run, check);
        for (std::size_t i = 0; i < part.size(); ++i) radiance[i] += part[i].point.emission;
        gather(part, radiance, run, check);
        addLamps(part, [&](std::size_t i, const glm::dvec3& lamps) { radiance[i] += lamps; });
        all.insert(all.end(), radiance.begin(), radiance.end());
        first = end;
    }
    return all;
}

}  // namespace lumulus::surface
