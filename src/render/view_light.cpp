#include "render/view_light.h"

#include <algorithm>

namespace lumulus {

namespace {

/// Light cells as fine as the photons of the map ask for, and a field for this view.
void makeRoom(gpu::Context& context, const cloud::Asset& asset, light::InstanceLight& light, InstanceView& seen) {
    const auto photons = std::max<std::uint64_t>(1, light.photons->photonsInRing());
    const cloud::CellGrid grid = light::lightGrid(asset, photons);
    if (!light.cells || !(grid == light.cells->grid())) {
        light.cells.reset();
        light.cells.emplace(context, asset, light.layouts->of(context, asset, grid), light.estimatorGrid);
        light.changed();
    }
    if (seen.field && grid == seen.field->grid()) return;
    seen.field.reset();
    seen.field.emplace(context, grid);
    seen.eye.reset();
}

light::CollisionEstimates estimates(const light::InstanceLight& light, const phase::ScatteringMedium& medium, int bands,
                                    const photon::Light& counted) {
    const photon::PhotonMap& photons = *light.photons;
    // a backward peak answers a change of direction in all bands at once, of which the first alone says nothing
    const bool known = bands > 1 && medium.tables.axisTable.empty();
    const double moment = known ? static_cast<double>(medium.tables.bandMoments[1]) : 0.0;
    return {*counted.counts, photons.estimatorBase(), counted.unit, photons.photonPower(), photons.massScale(), moment};
}

void recordShadow(gpu::Commands& commands, const cloud::Instance& instance, light::InstanceLight& light,
                  int reduction) {
    if (light.shadowReduction != 0 && light.shadowReduction <= reduction) return;
    light.shadow->record(commands, -light.sun.directionTo, instance.medium.extinction, reduction);
    light.shadowReduction = reduction;
    ++light.shadowVersion;
    light.sharpening = false;
}

/// Shadow volumes with what stands before them.
void shareShadows(GpuWork& work, World& world) {
    std::vector<light::Shading> all;
    for (const std::size_t i : world.visible()) {
        const light::InstanceLight& light = world.light[i];
        all.push_back({&world.instances[i], light.shadow ? &*light.shadow : nullptr, light.shadowVersion});
    }
    if (world.sharedShadow->isUpToDate(all)) return;
    work.run(
        [&](gpu::Commands& commands) { world.sharedShadow->record(commands, all, -world.lights.sun.directionTo); });
}

void recordField(gpu::Commands& commands, const cloud::Instance& instance, light::InstanceLight& light,
                 InstanceView& seen, const glm::vec3& eye, photon::Part part, int bands) {
    const bool all = part == photon::Part::all;
    if (all && seen.eye == eye && seen.version == light.version) return;
    photon::PhotonMap& photons = *light.photons;
    const photon::Light counted = photons.light(part);
    photons.reconstruct(commands, eye, counted);
    commands.barrier("collector radiance");
    if (!light.counted || !all) {
        light.cells->recordCounts(commands, photons.fluences(), estimates(light, instance.medium, bands, counted));
        light.counted = all;
    }
    seen.field->record(commands, *light.cells, eye, photons.radiance(), photons.colours());
    seen.eye = all ? std::optional(eye) : std::nullopt;
    seen.version = light.version;
}

}  // namespace

glm::vec3 eyeVoxel(const cloud::Instance& instance, const Camera& camera) {
    glm::dvec3 eye = camera.position;
    if (camera.projection == scene::Projection::orthographic) eye -= camera.axes[2] * (1e5 * instance.diagonal());
    return glm::vec3(instance.toVoxel(eye));
}

void lightView(GpuWork& work, World& world, ViewState::State& view, photon::Part part, int bands, int shadowReduction) {
    view.instances.resize(world.instances.size());
    for (const std::size_t i : world.visible())
        if (world.light[i].photons)
            makeRoom(work.context, *world.instances[i].asset, world.light[i], view.instances[i]);
    if (!world.hasShadows() && !world.hasPhotons()) return;
    work.run([&](gpu::Commands& commands) {
        for (const std::size_t i : world.visible()) {
            const cloud::Instance& instance = world.instances[i];
            light::InstanceLight& light = world.light[i];
            if (light.shadow) recordShadow(commands, instance, light, shadowReduction);
            if (light.photons)
                recordField(commands, instance, light, view.instances[i], eyeVoxel(instance, view.camera), part, bands);
        }
    });
    if (world.sharedShadow) shareShadows(work, world);
}

}  // namespace lumulus
