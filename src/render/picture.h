#pragma once

#include "fog/lit/lit_fog.h"
#include "fog/screen/fog.h"
#include "render/fog_change_view.h"
#include "render/ground_view.h"
#include "render/mesh_view.h"
#include "render/painter.h"
#include "render/renderer.h"

namespace lumulus {

/// The order of the passes of one picture. Its parts live elsewhere.
struct PictureOrder {
    GpuWork& work;
    World& world;
    const Painter* painter;    ///< null: there is nothing to draw
    fog::Fog* fog;             ///< null: there is no fog
    fog::LitFog* litFog;       ///< null: there is no fog in the light of sun and sky
    FogChangeView* fogChange;  ///< null: there is none, or no cloud in it
    GroundView* ground;        ///< null: there is no ground
    MeshView* meshes;          ///< null: there are no meshes, or the picture leaves them out
    int bands;                 ///< of the photon map
    int shadowReduction;       ///< that shadow volumes may have
    const Check& check;
    const Report& report;

    /// The picture of a view that the state shows.
    LayeredImage picture(ViewState::State& state, const View& view);
    /// Some rows by the even and by the odd generations.
    Preview preview(ViewState::State& state);

  private:
    /// Whether passes follow the drawing: the layers are then on the GPU.
    bool inFrame() const { return fog != nullptr || litFog != nullptr || !world.lights.environment.isConstant(); }
    void drawBackground(ViewState::State& state);
    void drawAtmosphere(ViewState::State& state);
    void drawMap(ViewState::State& state);
    LayeredImage throughFog(ViewState::State& state, const Tile& wanted);
    void finish(LayeredImage& image, ViewState::State& state);
    LayeredImage finishInFog(ViewState::State& state, const Tile& wanted);
    LayeredImage finishInLitFog(ViewState::State& state, const Tile& wanted);
    LayeredImage finishInFoggyAir(ViewState::State& state, const Tile& wanted);
    void drawLitFog(ViewState::State& state, const std::vector<shared::SunPixel>& sun,
                    const std::vector<glm::vec4>& groundSeen);
    std::vector<shared::SunPixel> discs(const ViewState::State& state, const glm::dvec3& eye) const;
    std::vector<glm::vec4> planetSeen(const ViewState::State& state);
    LayeredImage finished(ViewState::State& state, const Tile& wanted);
    void drawLight(ViewState::State& state, photon::Part part);
};

/// A picture of another renderer through fog; see Renderer::throughFog.
LayeredImage seenThroughFog(fog::Fog& fog, const scene::Fog& media, const Camera& camera, LayeredImage picture,
                            std::vector<float> depth);

}  // namespace lumulus
