#pragma once

#include <memory>
#include <vector>

#include "base/interrupt.h"
#include "gpu/commands.h"
#include "scene/fog.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::frame {
class Frame;
}

namespace lumulus::fog {

/// One layer of a picture: light and how far away it comes from, rows from the top.
struct Layer {
    std::vector<glm::vec4>
        radiance;  ///< RGB ≥ 0; alpha: how much of the pixel the layer covers (for the fog's emission)
    std::vector<float> distances;  ///< metres along the ray; shared::FAR_DEPTH where nothing ends it
};

/// The fog of a scene: makes of a clear picture what is seen through the fog. Exists only where there is fog.
/// Errors: Error where memory runs out.
class Fog {
  public:
    /// `scene` must have media. `check` is asked between the steps of the filter.
    Fog(gpu::Context& context, const scene::Fog& scene, Check check = stopIfInterrupted);
    ~Fog();

    /// Puts other media in the place of the scene's; it stays to have some.
    void setMedia(std::vector<scene::FogMedium> media);

    /// The layer as seen by `camera`, whose picture it fills: RGB of each pixel. Uploads the layer once and downloads
    /// the result once.
    std::vector<glm::vec4> apply(const Layer& layer, const Camera& camera);

    /// Shows a frame of `camera` through the fog, in place on the GPU: light of the cloud and radiance change in the
    /// part `part`. The cloud is a layer at its mean distance, with how much it covers. A sky of the same radiance
    /// everywhere stays so in fog, but for what is absorbed; what differs from `sky` is filtered as a layer behind all
    /// fog: light that the cloud takes out of the sky, and the sun's disc. Layers that are black are not filtered.
    void apply(const frame::Frame& frame, const Camera& camera, const glm::vec3& sky, const Tile& part);

    /// Adds to a frame, or takes off where `sign` is below 0, what of `light` the fog scatters on its way from the
    /// frame's depths, spread over the picture of `camera`. What comes straight is not added. `farthest`: the largest
    /// distance at which there is light [m].
    void addSpread(const frame::Frame& frame, const Camera& camera, const gpu::Image& light, float sign,
                   double farthest);

    /// Times of the passes of all apply() since the last call, added up by name.
    std::vector<gpu::PassTime> takeTimes();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lumulus::fog
