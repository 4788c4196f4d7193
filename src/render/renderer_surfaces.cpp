#include "base/error.h"
#include "lamp/air.h"
#include "lamp/lamp_picture.h"
#include "render/picture.h"
#include "render/renderer_state.h"
#include "render/world_media.h"

namespace lumulus {

void Renderer::State::setMeshes(const scene::Scene& scene) {
    meshes.emplace(context, scene, check);
    world->meshShade = [this](gpu::Commands& commands, const cloud::Instance& instance, const light::ShadowGrid& grid,
                              const gpu::Image& volume,
                              const glm::ivec3& origin) { meshes->shade(commands, instance, grid, volume, origin); };
    world->meshHeights = [this](const glm::dmat3& cells, const glm::dvec3& corner) -> const gpu::Buffer& {
        return meshes->forPhotons(context, *world, cells, corner);
    };
    if (ground)
        ground->setMeshes([this](const scene::Ground& on, const scene::Sun& sun, const glm::dvec3& sky) {
            return meshes->shadeOn(on, sun, sky);
        });
}

void Renderer::State::addLamps(LayeredImage& picture, const Camera& seen, const View& view, bool around) {
    if (seen.projection == scene::Projection::orthographic)
        throw InputError("lamps are not drawn in orthographic views", "camera.projection",
                         "use a perspective camera, or leave them out: --set lamp=[]");
    report("lamps", 0, 1);
    // as many as the photons of the map of sun and sky
    const std::int64_t paths =
        std::min<std::int64_t>(world->photonMap.photons / (view.coarse || around ? 16 : 1), 100'000'000);
    const light::LightSet& lights = world->lights;
    const sky::Atmosphere* air = lights.environment.atmosphere();
    const scene::Fog haze = air != nullptr ? lamp::withAir(world->fog, air->air(), air->groundHeight()) : world->fog;
    lamp::addLamps(
        picture, seen, drawnTile(view),
        {lamps, haze, lights.planet ? lights.planet : lights.ground, static_cast<int>(paths), world->photonMap.seed,
         cloudsForLamps(context, *world, check), meshes && !around ? &meshes->solids() : nullptr, !around},
        check);
    report("lamps", 1, 1);
}

void Renderer::State::lightMeshes(PictureOrder& order) {
    report("light on meshes", 0, 1);
    meshes->setSun(context, *world, check);
    const View around = meshes->surroundings(*world);
    ViewState from;
    show(from.state(), around);
    LayeredImage seen = order.picture(from.state(), around);
    if (!lamps.empty()) addLamps(seen, from.state().camera, around, true);
    meshes->setLight(context, *world, seen, lamps, check);
    report("light on meshes", 1, 1);
}

}  // namespace lumulus
