#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "fog/lit/lit_fog.h"
#include "fog/screen/fog.h"
#include "render/fog_change_view.h"
#include "render/gpu_work.h"
#include "render/ground_view.h"
#include "render/mesh_view.h"
#include "render/painter.h"
#include "render/renderer.h"
#include "render/world.h"

namespace lumulus {

/// What a renderer owns: the device, the world, and what draws it. What a scene does not need does not exist.
struct Renderer::State {
    State(const scene::Scene& scene, const RendererOptions& options, std::shared_ptr<gpu::Context> device)
        : camera(scene.camera),
          image(scene.image),
          report(options.report),
          check(options.check),
          ownContext(std::move(device)),
          context(*ownContext),
          keepRing(options.keepRing) {
        std::ranges::copy_if(scene.lamps, std::back_inserter(lamps), &scene::Lamp::shines);
    }

    scene::Camera camera;  ///< of the scene's view
    scene::Image image;
    Report report;
    Check check;
    std::shared_ptr<gpu::Context> ownContext;  ///< shared by renderers that differ in light
    gpu::Context& context;
    GpuWork work{context};
    std::optional<World> world;
    std::optional<Painter> painter;
    std::optional<fog::Fog> fog;
    std::optional<fog::LitFog> litFog;
    std::optional<FogChangeView> fogChange;
    std::optional<GroundView> ground;
    std::optional<MeshView> meshes;
    std::vector<scene::Lamp> lamps;           ///< that shine
    std::map<std::size_t, glm::dvec3> moved;  ///< ways of the clouds that do not lie where the scene has them [m]
    int sunAllowed = 1;                       ///< reduction of shadow volumes
    int sinceChange = 0;                      ///< generations under the light of now
    bool otherFog = false;                    ///< the fog is not the scene's any more
    bool tracesLightOfNow = false;            ///< the generation that is traced is one of them
    bool keepRing;
    Statistics statistics;

    /// Makes what draws the world.
    void makePainters(const scene::Scene& scene);
    /// Sets what the view state keeps of a view.
    void show(ViewState::State& state, const View& view) const;
    /// Sets the meshes of the scene, which throw shadows on the ground too.
    void setMeshes(const scene::Scene& scene);
    /// Adds the light of lamps to a picture of a view.
    /// `around`: the view shows what surrounds the meshes, without meshes and lamps themselves.
    void addLamps(LayeredImage& picture, const Camera& seen, const View& view, bool around = false);
    /// Draws what surrounds the meshes, by the order of a picture without them.
    void lightMeshes(struct PictureOrder& order);
    int raysAcross(const Camera& camera, int most) const;
    void lightChanged();
};

}  // namespace lumulus
