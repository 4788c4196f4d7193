#pragma once

#include <optional>
#include <vector>

#include "frame/frame.h"
#include "light/fog_change/fog_change.h"
#include "light/fog_light/fog_light.h"
#include "scene/fog.h"
#include "shared/lit_fog.h"
#include "view/camera.h"

namespace lumulus::fog {

/// Clouds that throw shadows into fog: ten texels each (shared/lit_fog.h), and their shadow volumes in one image.
/// Meshes that do are one more behind them, with a map of their heights.
struct ShadowCasters {
    std::vector<glm::vec4> texels;
    const gpu::Image* volumes = nullptr;  ///< null: no cloud throws a shadow
    const gpu::Image* meshes = nullptr;   ///< null: no mesh does
    glm::vec3 inverseSize{1.0F};          ///< of that image, where there are several clouds
};

/// Where an eye is above a round planet, whose middle is so far from it [m].
struct EyeAbove {
    glm::dvec3 up{0.0, 1.0, 0.0};
    double fromMiddle = 0.0;
    std::optional<double> aboveTop{};  ///< of the fog, where it is above it [m]; none in the fog, which is level
};

/// Fog in the light of sun and sky, in a frame. One texel stands for what a scene does not have.
class LitFog {
  public:
    /// What a scene has.
    struct Has {
        bool shadows = false;  ///< of clouds or meshes
        bool many = false;     ///< clouds
        bool ground = false;   ///< at which rays end
        bool air = false;      ///< in which the fog is
        bool change = false;   ///< of the fog's light by clouds
    };
    LitFog(gpu::Context& context, const Has& has);

    /// Uploads the tables of the light, where its `version` is not that of the last call.
    void update(const fog_light::FogLight& light, std::uint64_t version);
    /// Records the pass over a frame that shows the part `tile` of the camera's picture without fog. `groundSeen`: RGB
    /// and share of the ground in each pixel of the tile; empty without a ground. `fog`: with the media of the air.
    /// `change`: what clouds change as this camera sees it; null: there is none. `skyBehind`: the sky in each pixel
    /// where it is an atmosphere's, and where the `eye` is above it.
    void record(gpu::Commands& commands, const frame::Frame& frame, const Camera& camera, const Tile& tile,
                const scene::Fog& fog, const ShadowCasters& casters, const fog_change::ChangeSeen* change,
                const std::vector<glm::vec4>& groundSeen, const gpu::Image* skyBehind = nullptr,
                const EyeAbove& eye = {});

    /// What record() found, once its commands are done: light of clouds that the fog on its way scatters, beyond what
    /// the fog would send without them (more) and what it lacks (less), as the filter takes it.
    struct Excess {
        const gpu::Image* more = nullptr;  ///< null: no pixel has any
        const gpu::Image* less = nullptr;
        double farthest = 0.0;  ///< largest distance of a cloud [m]
    };
    Excess excess() const;

  private:
    shared::LitFogParams paramsOf(const Camera& camera, const Tile& tile, const ShadowCasters& casters,
                                  const EyeAbove& eye) const;

    gpu::Context& context_;
    bool ground_;
    gpu::Program<gpu::NoPush> program_;
    gpu::Buffer params_, summary_;
    gpu::Image none_, noVolume_, noChange_;
    std::optional<std::uint64_t> version_;
    const fog_light::FogLight* light_ = nullptr;  ///< valid between update() and record()
    std::optional<gpu::Image> levels_, scattered_, once_, change_, groundSeen_, more_, less_;
    std::optional<gpu::Buffer> media_, casters_;
};

}  // namespace lumulus::fog
