#pragma once

#include <optional>

#include "fog/lit/lit_fog.h"
#include "frame/frame.h"
#include "render/gpu_work.h"
#include "render/world.h"
#include "surface/mesh/ground_shade.h"
#include "surface/mesh/mesh_picture.h"
#include "surface/mesh/sun_map.h"
#include "view/view.h"

namespace lumulus {

/// The meshes of a scene as pictures show them.
class MeshView {
  public:
    /// Errors: those of surface::MeshScene and surface::RayTracer.
    MeshView(gpu::Context& context, const scene::Scene& scene, const Check& check);

    /// What surrounds the meshes: a panorama from their middle, but above a ground.
    View surroundings(const World& world) const;
    /// Sets the sun that they stand before, as clouds and fog have their shadows of it. Errors: what `check` throws.
    void setSun(gpu::Context& context, const World& world, const Check& check);
    /// After setSun(): adds them to what throws shadows into fog; as World::meshShade has it.
    void addTo(fog::ShadowCasters& casters, const glm::dvec3& eye) const;
    void shade(gpu::Commands& commands, const cloud::Instance& instance, const light::ShadowGrid& grid,
               const gpu::Image& volume, const glm::ivec3& origin) const;
    /// As World::meshHeights has it; sets the sun too. Errors: Error where interrupted.
    const gpu::Buffer& forPhotons(gpu::Context& context, const World& world, const glm::dmat3& cells,
                                  const glm::dvec3& corner);
    /// Sets the light that they stand in. `seen`: the picture of surroundings(), without meshes; `lamps`: that shine.
    /// Errors: what `check` throws.
    void setLight(gpu::Context& context, World& world, const LayeredImage& seen, const std::vector<scene::Lamp>& lamps,
                  const Check& check);
    /// The meshes as they stand in the light of lamps. This object outlives it.
    const lamp::Solids& solids() const { return solids_; }
    /// The meshes in a part of a picture, without what is before them. After setLight().
    surface::MeshPixels draw(GpuWork& work, const World& world, const Camera& camera, const Tile& tile, bool coarse,
                             const Check& check);

    /// What the meshes do to the light on a ground. Errors: Error where interrupted.
    surface::GroundMeshes shadeOn(const scene::Ground& ground, const scene::Sun& sun, const glm::dvec3& sky) const;

  private:
    surface::MeshScene scene_;
    lamp::Solids solids_;
    surface::RayTracer tracer_;
    std::optional<surface::SunMap> sunMap_;
    std::optional<gpu::Buffer> forPhotons_;
    std::optional<surface::MeshLight> light_;
    std::optional<surface::MeshShading> shading_;
};

/// Refuses what a renderer cannot do with meshes. `served`: scenes are changed while they are shown.
void requireDrawableMeshes(const scene::Scene& scene, bool served);

/// Draws meshes where there is no cloud before them, into the image or, where it is null, the frame of the view, which
/// show() has set and whose tile `tile` is.
void paintMeshes(GpuWork& work, const surface::MeshPixels& meshes, const Tile& tile, const glm::vec3& sky,
                 const frame::Frame* frame, LayeredImage* image);

}  // namespace lumulus
