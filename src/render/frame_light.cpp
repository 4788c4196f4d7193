#include "render/frame_light.h"

#include <cmath>
#include <vector>

#include "gpu/transfer.h"
#include "light/photon/map_layout.h"
#include "vdb/transform.h"

namespace lumulus {

namespace {

/// Voxels of an instance → coordinates of the cloud before the scene's `transform`, in which its files are.
vdb::Affine toCloud(const cloud::Instance& instance, const glm::dmat4& transform) {
    const glm::dmat3 back = glm::inverse(glm::dmat3(transform));
    const vdb::Affine toOwn{back, -(back * glm::dvec3(transform[3]))};
    return vdb::composed(toOwn, {instance.voxelToMetres, instance.origin});
}

photon::CarriedCloud carriedCloud(gpu::Context& context, const photon::MapPart& part, const cloud::Instance& instance,
                                  light::InstanceLight& light, const glm::dmat4& transform) {
    photon::CarriedCloud cloud;
    cloud.toCloud = toCloud(instance, transform);
    cloud.size = part.asset->size;
    cloud.cells = part.estimates;
    cloud.firstCollector = part.firstCollector;
    cloud.estimatorBase = part.estimatorBase;
    if (part.collectors == 0) return cloud;
    const double scale = part.massScale();
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

photon::CarriedPlan planOf(gpu::Context& context, World& world, const scene::Scene& scene) {
    const photon::MapPlan map = world.photons->plan();
    photon::CarriedPlan plan;
    const std::vector<std::size_t> visible = world.visible();
    for (std::size_t i = 0; i < map.parts.size(); ++i) {
        const std::size_t number = visible[i];
        plan.clouds.push_back(carriedCloud(context, map.parts[i], world.instances[number], world.light[number],
                                           scene.clouds[number].transform));
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

}  // namespace

std::optional<FrameLight> frameLightOf(gpu::Context& context, World& world, const scene::Scene& scene) {
    if (!world.photons) return std::nullopt;
    FrameLight light{planOf(context, world, scene), world.photons->tracedSums()};
    light.plan.counts = static_cast<std::uint32_t>(light.sums.counts.size());
    return light;
}

bool carryLight(gpu::Context& context, World& world, const scene::Scene& scene, const FrameLight& before,
                std::span<const photon::Way> ways, int generations) {
    if (!world.photons || !before.sums.unitExponent || generations <= 0) return false;
    photon::CarriedPlan plan = planOf(context, world, scene);
    const photon::TracedSums traced = world.photons->tracedSums();
    plan.counts = static_cast<std::uint32_t>(traced.counts.size());
    if (!photon::hasLightFor(before.plan, plan)) return false;
    std::vector<photon::Way> ofParts;
    for (const photon::CarriedCloud& cloud : plan.clouds) ofParts.push_back(ways[cloud.number]);
    const int unit = traced.unitExponent.value_or(*before.sums.unitExponent);
    const double factor = std::ldexp(1.0, *before.sums.unitExponent - unit);
    world.photons->add(photon::carriedCounts(before.plan, before.sums.counts, plan, ofParts, generations, factor),
                       generations, unit);
    for (light::InstanceLight& light : world.light) light.changed();
    return true;
}

}  // namespace lumulus
