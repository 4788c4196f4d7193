#include "render/view_light.h"

#include <algorithm>

namespace lumulus {

namespace {

/// In the world [m], for what is seen of all clouds together.
glm::dvec3 eyeOf(const Bounds& bounds, const Camera& camera) {
    if (camera.projection != scene::Projection::orthographic) return camera.position;
    return camera.position - camera.axes[2] * (1e5 * 2.0 * bounds.radius());
}

light::CountedCells& cellsFor(light::InstanceLight& light, const ViewState::State& view) {
    return view.coarse ? light.coarse : light.fine;
}

/// Light cells as fine as the photons of the map ask for, or coarse ones, and a field for this view.
void makeRoom(gpu::Context& context, const World& world, light::InstanceLight& light, const ViewState::State& view,
              InstanceView& seen) {
    const photon::MapPart& part = world.photons->parts()[*light.part];
    const auto photons = std::max<std::uint64_t>(1, world.photons->photonsOf(*light.part));
    const cloud::CellGrid fine = light::lightGrid(*part.asset, photons, light.fewestCells);
    const cloud::CellGrid grid = view.coarse ? light::coarseLightGrid(*part.asset, fine) : fine;
    light::CountedCells& counted = cellsFor(light, view);
    if (!counted.cells || !(grid == counted.cells->grid())) {
        counted.cells.reset();
        counted.cells.emplace(context, *part.asset, light.layouts->of(context, *part.asset, grid), part.estimates,
                              part.voxelToMetres, part.firstCollector, view.coarse);
        counted.counted = false;
    }
    if (seen.field && grid == seen.field->grid()) return;
    seen.field.reset();
    seen.field.emplace(context, grid);
    seen.eye.reset();
}

light::CollisionEstimates estimates(const photon::PhotonMap& photons, std::size_t number, int bands,
                                    const photon::Light& counted) {
    const photon::MapPart& part = photons.parts()[number];
    const phase::ScatteringTables& tables = part.medium.tables;
    // a backward peak answers a change of direction in all bands at once, of which the first alone says nothing
    const bool known = bands > 1 && tables.axisTable.empty();
    const double moment = known ? static_cast<double>(tables.bandMoments[1]) : 0.0;
    return {*counted.counts, part.estimatorBase, counted.unit, photons.photonPower(number), photons.massScale(number),
            moment};
}

/// `meshShade`: World's, where no other instance shades this one.
void recordShadow(gpu::Commands& commands, const cloud::Instance& instance, light::InstanceLight& light, int reduction,
                  const decltype(World::meshShade)& meshShade) {
    if (light.shadowReduction != 0 && light.shadowReduction <= reduction) return;
    light.shadow->record(commands, -light.sun.directionTo, instance.medium.extinction, reduction);
    if (meshShade) {
        commands.barrier("shadow volume");
        meshShade(commands, instance, light.shadow->grid(), light.shadow->image(), glm::ivec3(0));
    }
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
    work.run([&](gpu::Commands& commands) {
        world.sharedShadow->record(commands, all, -world.lights.direct().directionTo);
        for (std::size_t place = 0; world.meshShade && place < all.size(); ++place) {
            if (all[place].shadow == nullptr) continue;
            world.meshShade(commands, *all[place].instance, all[place].shadow->grid(), world.sharedShadow->image(),
                            world.sharedShadow->origin(place));
            commands.barrier("mesh shadow");
        }
    });
}

/// The light field of one instance, from the collectors of all.
void recordField(gpu::Commands& commands, const photon::PhotonMap& photons, const photon::Light& counted,
                 const light::InstanceLight& light, light::CountedCells& cells, InstanceView& seen,
                 const glm::vec3& eye, int bands, bool all) {
    if (!cells.counted || !all) {
        cells.cells->recordCounts(commands, photons.fluences(), estimates(photons, *light.part, bands, counted));
        cells.counted = all;
    }
    seen.field->record(commands, *cells.cells, eye, photons.radiance(), photons.colours());
    seen.eye = all ? std::optional(eye) : std::nullopt;
    seen.version = light.version;
}

/// Instances that the view shows, whose light fields are not what it needs.
std::vector<std::size_t> oldFields(const World& world, const ViewState::State& view, photon::Part part) {
    std::vector<std::size_t> numbers;
    const std::vector<std::size_t> visible = world.visible();
    for (std::size_t place = 0; place < visible.size(); ++place) {
        const std::size_t i = visible[place];
        if (view.tiles && !view.tiles->isListed(place)) continue;
        const light::InstanceLight& light = world.light[i];
        const InstanceView& seen = view.instances[i];
        const bool fits = part == photon::Part::all && seen.version == light.version && seen.eye &&
                          *seen.eye == eyeVoxel(world.instances[i], view.camera);
        if (light.part && !fits) numbers.push_back(i);
    }
    return numbers;
}

/// Submissions end after so many instances: commands hold only so many passes.
constexpr std::size_t atOnce = 128;

void makeFields(GpuWork& work, World& world, ViewState::State& view, photon::Part part, int bands) {
    const std::vector<std::size_t> old = oldFields(world, view, part);
    if (old.empty()) return;
    photon::PhotonMap& photons = *world.photons;
    const photon::Light counted = photons.light(part);
    const bool many = photons.parts().size() > 1;
    for (std::size_t done = 0; done < old.size(); done += atOnce)
        work.run([&](gpu::Commands& commands) {
            if (done == 0) {
                const glm::vec3 eye = many ? glm::vec3(eyeOf(world.bounds, view.camera) - photons.corner())
                                           : eyeVoxel(world.instances[old.front()], view.camera);
                photons.reconstruct(commands, eye, counted);
                commands.barrier("collector radiance");
            }
            for (std::size_t k = done; k < std::min(done + atOnce, old.size()); ++k) {
                const std::size_t i = old[k];
                recordField(commands, photons, counted, world.light[i], cellsFor(world.light[i], view),
                            view.instances[i], eyeVoxel(world.instances[i], view.camera), bands,
                            part == photon::Part::all);
            }
        });
}

}  // namespace

void makeShadows(GpuWork& work, World& world, int reduction) {
    std::vector<std::size_t> old;
    for (const std::size_t i : world.visible()) {
        const light::InstanceLight& light = world.light[i];
        if (light.shadow && (light.shadowReduction == 0 || light.shadowReduction > reduction)) old.push_back(i);
    }
    for (std::size_t done = 0; done < old.size(); done += atOnce)
        work.run([&](gpu::Commands& commands) {
            for (std::size_t k = done; k < std::min(done + atOnce, old.size()); ++k)
                recordShadow(commands, world.instances[old[k]], world.light[old[k]], reduction,
                             world.sharedShadow ? nullptr : world.meshShade);
        });
    if (world.sharedShadow) shareShadows(work, world);
}

glm::vec3 eyeVoxel(const cloud::Instance& instance, const Camera& camera) {
    glm::dvec3 eye = camera.position;
    if (camera.projection == scene::Projection::orthographic) eye -= camera.axes[2] * (1e5 * instance.diagonal());
    return glm::vec3(instance.toVoxel(eye));
}

void lightView(GpuWork& work, World& world, ViewState::State& view, photon::Part part, int bands, int shadowReduction) {
    view.instances.resize(world.instances.size());
    const std::vector<std::size_t> visible = world.visible();
    for (std::size_t place = 0; place < visible.size(); ++place)
        if (const std::size_t i = visible[place]; world.light[i].part && (!view.tiles || view.tiles->isListed(place)))
            makeRoom(work.context, world, world.light[i], view, view.instances[i]);
    makeShadows(work, world, shadowReduction);
    if (world.photons) makeFields(work, world, view, part, bands);
}

}  // namespace lumulus
