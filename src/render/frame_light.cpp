#include "render/frame_light.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "gpu/transfer.h"
#include "light/photon/map_layout.h"
#include "vdb/transform.h"
#include "volume/motion.h"

namespace lumulus {

namespace {

/// Voxels of an instance → coordinates of the cloud before the scene's `transform`, in which its files are.
vdb::Affine toCloud(const cloud::Instance& instance, const glm::dmat4& transform) {
    const glm::dmat3 back = glm::inverse(glm::dmat3(transform));
    const vdb::Affine toOwn{back, -(back * glm::dvec3(transform[3]))};
    return vdb::composed(toOwn, {instance.voxelToMetres, instance.origin});
}

photon::CarriedCloud carriedCloud(gpu::Context& context, const photon::MapPart& part, const cloud::Instance& instance,
                                  light::InstanceLight& light, const glm::dmat4& transform, double extinction) {
    photon::CarriedCloud cloud;
    cloud.toCloud = toCloud(instance, transform);
    cloud.size = part.asset->size;
    cloud.cells = part.estimates;
    cloud.firstCollector = part.firstCollector;
    cloud.estimatorBase = part.estimatorBase;
    if (part.collectors == 0) return cloud;
    const double scale = part.massScale() * extinction;
    for (const cloud::Collector& collector : part.asset->collectors) {
        cloud.places.push_back(cloud.toCloud.point(glm::dvec3(collector.centre)));
        cloud.masses.push_back(static_cast<double>(collector.mass) * scale);
    }
    if (part.estimates.edge == 0) return cloud;
    const auto layout = light.layouts->of(context, *part.asset, part.estimates);
    for (const float mass : gpu::download<float>(context, layout->mass))
        cloud.cellMasses.push_back(static_cast<double>(mass) * scale);
    return cloud;
}

/// `extinctions`: those that counts of the parts are of, over that of their medium.
photon::CarriedPlan planOf(gpu::Context& context, World& world, const scene::Scene& scene,
                           std::span<const double> extinctions) {
    const photon::MapPlan map = world.photons->plan();
    photon::CarriedPlan plan;
    const std::vector<std::size_t> visible = world.visible();
    for (std::size_t i = 0; i < map.parts.size(); ++i) {
        const std::size_t number = visible[i];
        plan.clouds.push_back(carriedCloud(context, map.parts[i], world.instances[number], world.light[number],
                                           scene.clouds[number].transform, extinctions[i]));
        plan.clouds.back().number = number;
    }
    plan.bands = map.bands;
    plan.axisBase = map.axisBase;
    plan.groundBase = photon::groundBase(map.parts, map.axisBase);
    const std::uint32_t collectors = photon::collectorsOf(map.parts);
    plan.axisCounts = collectors > 0 ? (plan.groundBase - plan.axisBase) / collectors : 0;
    plan.generations = world.photons->generationsInRing();
    return plan;
}

std::vector<photon::Way> waysOfParts(const photon::CarriedPlan& plan, std::span<const photon::Way> ways) {
    std::vector<photon::Way> ofParts;
    for (const photon::CarriedCloud& cloud : plan.clouds) ofParts.push_back(ways[cloud.number]);
    return ofParts;
}

/// Extinctions of now of the parts, over those of their media.
std::vector<double> extinctionsNow(const World& world) {
    std::vector<double> extinctions;
    const std::vector<std::size_t> visible = world.visible();
    for (std::size_t i = 0; i < visible.size(); ++i)
        extinctions.push_back(world.instances[visible[i]].medium.extinction /
                              world.photons->parts()[i].medium.extinction);
    return extinctions;
}

}  // namespace

FrameMotion motionOf(const FrameLight& light, const scene::Scene& before, const scene::Scene& now,
                     const vdb::ReadLimits& limits) {
    FrameMotion result;
    result.ways.assign(now.clouds.size(), CloudMotion().way);
    for (const photon::CarriedCloud& cloud : light.plan.clouds) {
        const std::size_t i = cloud.number;
        CloudMotion motion = motionBetween(before.clouds[i], now.clouds[i], {cloud.toCloud, cloud.size}, limits);
        result.goesOn = result.goesOn && motion.goesOn;
        result.known = result.known && motion.known;
        result.ways[i] = std::move(motion.way);
    }
    return result;
}

std::optional<FrameLight> frameLightOf(gpu::Context& context, World& world, const scene::Scene& scene) {
    if (!world.photons) return std::nullopt;
    const std::vector<double> extinctions = world.photons->meanExtinctions();
    FrameLight light{planOf(context, world, scene, extinctions), world.photons->tracedSums(), world.bounds.radius()};
    light.plan.counts = static_cast<std::uint32_t>(light.sums.counts.size());
    return light;
}

std::uint64_t frameLightBytes(const World& world) {
    if (!world.photons) return 0;
    const std::span<const photon::MapPart> parts = world.photons->parts();
    constexpr std::uint64_t ofCollector = sizeof(glm::dvec3) + sizeof(double);
    std::uint64_t bytes = world.photons->countsOfAll() * sizeof(std::int64_t);
    for (const photon::MapPart& part : parts)
        bytes += part.collectors * ofCollector + part.estimates.count() * sizeof(double);
    return bytes;
}

bool carryLight(gpu::Context& context, World& world, const scene::Scene& scene, const FrameLight& before,
                std::span<const photon::Way> ways, int generations) {
    if (!world.photons || !before.sums.unitExponent || generations <= 0) return false;
    photon::CarriedPlan plan = planOf(context, world, scene, world.photons->meanExtinctions());
    const photon::TracedSums traced = world.photons->tracedSums();
    plan.counts = static_cast<std::uint32_t>(traced.counts.size());
    if (!photon::hasLightFor(before.plan, plan)) return false;
    const std::vector<photon::Way> ofParts = waysOfParts(plan, ways);
    const int unit = traced.unitExponent.value_or(*before.sums.unitExponent);
    const double factor = std::ldexp(1.0, *before.sums.unitExponent - unit);
    world.photons->add(photon::carriedCounts(before.plan, before.sums.counts, plan, ofParts, generations, factor),
                       generations, unit);
    for (light::InstanceLight& light : world.light) light.changed();
    return true;
}

bool carryRing(gpu::Context& context, World& world, const scene::Scene& scene, const FrameLight& before,
               std::span<const photon::Way> ways, const Check& check) {
    if (!world.photons || !before.sums.unitExponent || before.sums.generationsTraced() == 0) return false;
    std::vector<double> extinctions = extinctionsNow(world);
    photon::CarriedPlan plan = planOf(context, world, scene, extinctions);
    plan.counts = world.photons->countsOfAll();
    bool any = false;
    for (std::size_t i = 0; i < plan.clouds.size(); ++i) {
        const bool known = std::ranges::any_of(before.plan.clouds, [&](const photon::CarriedCloud& cloud) {
            return cloud.number == plan.clouds[i].number && !cloud.places.empty();
        });
        any = any || (known && !plan.clouds[i].places.empty());
        if (known) continue;
        plan.clouds[i].places.clear();
        extinctions[i] = 0.0;
    }
    if (!any || !photon::hasLightFor(before.plan, plan)) return false;
    // the unit follows the size of the clouds, so that integers stay as fine whatever grows or shrinks
    const double growth =
        before.radius > 0.0 && world.bounds.radius() > 0.0 ? world.bounds.radius() / before.radius : 1.0;
    const int unit = *before.sums.unitExponent + static_cast<int>(std::lround(2.0 * std::log2(growth)));
    const double factor = std::ldexp(1.0, *before.sums.unitExponent - unit);
    const std::vector<std::int64_t> counts = photon::carriedCounts(
        before.plan, before.sums.counts, plan, waysOfParts(plan, ways), before.plan.generations, factor, check);
    world.photons->goOnFrom(counts, before.sums, unit, extinctions);
    for (light::InstanceLight& light : world.light) light.changed();
    return true;
}

}  // namespace lumulus
