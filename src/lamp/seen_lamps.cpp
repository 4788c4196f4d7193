#include "lamp/seen_lamps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lamp/once_scattered.h"

namespace lumulus::lamp {

namespace {

/// Error of each group of lamps over the light of all, at most, as Standing::error() estimates it.
constexpr double fogTolerance = 1.5e-4, groundTolerance = 6e-4;
/// Largest distance of a lamp from the middle of its group over that of the group from the place that it lights.
constexpr double widestGroup = 0.5;
/// Error in the shade, over the group's size.
constexpr double shadeSlope = 0.5;
/// Optical depth behind which the ground is not seen.
constexpr double opaque = 14.0;

/// Where a group stands for its lamps.
struct Standing {
    const LampNode& node;
    double away;        ///< from the place that it lights [m]
    double extinction;  ///< of the haze there [1/m]

    Standing(const Haze& haze, const LampNode& group, double distance)
        : node(group),
          away(distance),
          extinction(haze.isClear() || group.isOne() ? 0.0 : luminanceOf(haze.extinction(group.beam->position()))) {}

    bool isTooNear() const { return !node.isOne() && !(node.reach < widestGroup * away); }

    /// What the light of the ground, e^(−σr)/r³, has more of the lamps than of the group over it: by the Laplacian in
    /// the plane, for lamps all around their middle.
    double groundCurve() const {
        return 0.25 * node.variance * (extinction * extinction + 5.0 * extinction / away + 9.0 / (away * away));
    }

    /// The same in fog, e^(−σr)/r, of either sign.
    double fogCurve() const { return node.variance * (0.25 * extinction * extinction + 0.5 / (away * away)); }

    /// Error of the group's light over this light, by its curve and by what differs between the lamps.
    double error(double curve) const {
        if (node.isOne()) return 0.0;
        double error = curve + node.shift / away;
        if (!node.beam->isPoint()) error += std::sqrt(node.variance) / (away * std::max(0.02, node.beam->fading()));
        if (node.beam->isShaded()) error += shadeSlope * std::sqrt(node.variance) / away;
        return error;
    }
};

/// At least the half width of the bundle, so that a lamp among its rays counts by the mean over them.
double missIn(const RayBundle& rays, const Beam& beam) {
    const double along = glm::dot(beam.position() - rays.middle.origin, rays.middle.direction);
    return std::max({missOf(rays.middle, beam.position()), beam.radius(), 0.5 * rays.widthAt(along)});
}

/// What may be scattered along the middle of the rays, for a medium of 1 m⁻¹ that scatters evenly.
double passing(const Haze& haze, const RayBundle& rays, const Beam& beam) {
    const Ray& ray = rays.middle;
    const double nearest = glm::dot(beam.position() - ray.origin, ray.direction), miss = missIn(rays, beam);
    const double angle = std::atan((rays.end - nearest) / miss) + std::atan(nearest / miss);
    const double light = luminanceOf(beam.intensity(beam.direction())) * angle / miss;
    if (haze.isClear()) return light;
    const glm::dvec3 way = ray.origin + std::clamp(nearest, 0.0, rays.end) * ray.direction - beam.position();
    const double away = glm::length(way);
    if (!(away > 0.0)) return light;
    return light * std::exp(-haze.depth({beam.position(), way / away}, away).y);
}

template <class Measure>
SeenLamps seenBy(const Haze& haze, std::span<const LampNode* const> groups, const RayBundle& rays, double done,
                 const Measure& measure) {
    SeenLamps result{{}, done};
    LampTree::cut(
        groups, rays.isNarrow() ? fogTolerance : 0.0, done,
        [&](const LampNode& node) {
            NodeLight found{&node, glm::dvec3(0.0), 1.0, std::numeric_limits<double>::infinity()};
            const Standing standing(haze, node, distanceTo(rays, node.beam->position()));
            if (standing.isTooNear()) return found;
            found.error = standing.error(standing.fogCurve());
            if (mayLight(*node.beam, node.reach, rays))
                measure(found);
            else
                found.bound = 0.0;
            return found;
        },
        result.nodes);
    if (!rays.isNarrow())
        result.light = 0.0;
    else
        for (const NodeLight& node : result.nodes) result.light += luminanceOf(node.light);
    return result;
}

}  // namespace

SeenLamps lampsInFog(std::span<const LampNode* const> groups, const Haze& haze, const RayBundle& rays, double done) {
    const auto along = [&](const Beam& beam) {
        return onceScattered(haze, beam, rays.middle, {0.0, rays.end}, missIn(rays, beam));
    };
    return seenBy(haze, groups, rays, done, [&](NodeLight& found) {
        const Beam& beam = *found.node->beam;
        found.light = along(beam);
        const bool asBright = found.node->bound == &beam && !beam.isShaded();
        found.bound = luminanceOf(asBright ? found.light : along(*found.node->bound));
    });
}

LampsAlong::LampsAlong(const LampTree& tree, const Haze& haze, const RayBundle& rays)
    : haze_(haze),
      rays_(rays),
      groups_(tree.groups([&](const LampNode& node) { return mayLight(*node.beam, node.reach, rays); })) {
    for (const LampNode* group : groups_)
        (group->beam->isPoint() && !group->beam->isShaded() ? smooth_ : others_).push_back(group);
}

SeenLamps LampsAlong::amongClouds() const {
    return seenBy(haze_, groups_, rays_, 0.0, [&](NodeLight& found) {
        found.bound = passing(haze_, rays_, *found.node->bound);
        found.light = glm::dvec3(passing(haze_, rays_, *found.node->beam));
    });
}

glm::dvec3 LampsAlong::onGround(const scene::Ground& ground, const Ray& ray, double metres) const {
    thread_local std::vector<NodeLight> lamps;  // no allocation a ray
    const glm::dvec3 before = haze_.isClear() ? glm::dvec3(0.0) : haze_.depth(ray, metres);
    if (std::min({before.x, before.y, before.z}) > opaque) return glm::dvec3(0.0);
    const glm::dvec3 point = ray.origin + metres * ray.direction;
    LampTree::cut(
        groups_, groundTolerance, 0.0,
        [&](const LampNode& node) {
            const Beam& beam = *node.beam;
            const glm::dvec3 way = beam.position() - point;
            const double distance = std::max(glm::length(way), beam.radius());
            NodeLight found{&node, glm::dvec3(0.0), 1.0, std::numeric_limits<double>::infinity()};
            const Standing standing(haze_, node, distance);
            if (standing.isTooNear()) return found;
            found.error = standing.error(standing.groundCurve());
            found.bound = 0.0;
            const glm::dvec3 direction = way / distance;
            const double share = beam.share(-direction);
            // of one lamp that does not light the place nothing is left
            if (!(way.y > 0.0) || (node.isOne() && !(share > 0.0))) return found;
            const double falling = direction.y / (distance * distance);
            const glm::dvec3 left =
                haze_.isClear() ? glm::dvec3(1.0) : glm::exp(-haze_.depth({point, direction}, distance));
            if (share > 0.0)
                found.light = beam.power() * left *
                              (share * falling * (1.0 + standing.groundCurve()) * beam.passed(-direction, distance));
            found.bound = luminanceOf(node.bound->power() * left) * falling * 0.25 * std::numbers::inv_pi;
            return found;
        },
        lamps);
    glm::dvec3 irradiance(0.0);
    for (const NodeLight& one : lamps) irradiance += one.light;
    return ground.albedo * std::numbers::inv_pi * irradiance * glm::exp(-before);
}

}  // namespace lumulus::lamp
