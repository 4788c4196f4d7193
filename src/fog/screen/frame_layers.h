#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "fog/screen/open_sky.h"
#include "frame/frame.h"
#include "gpu/commands.h"
#include "shared/fog_layers.h"

namespace lumulus::fog {

/// The layers of a frame that the filter sees, on the GPU. The cloud is the frame's own layer; what the background
/// differs from a uniform sky by lies behind all fog. In each pixel a cloud stands at one distance.
class FrameLayers {
  public:
    /// What recordSplit() found, once its commands are done.
    struct Present {
        bool clouded = false;   ///< some pixel shows some cloud
        bool lit = false;       ///< some pixel's background has more light than the sky
        double farthest = 0.0;  ///< largest depth of the frame in metres
    };

    FrameLayers(gpu::Context& context, const glm::ivec2& size);

    /// Light that the cloud takes out of the sky, and light that the background has more (the sun's disc). Both are
    /// filtered in place.
    const gpu::Image& shadow() const { return shadow_; }
    const gpu::Image& bright() const { return bright_; }
    /// The distance of both, one texel for all pixels.
    const gpu::Image& far() const { return far_; }
    /// The cloud as seen through the fog: the filter's result.
    const gpu::Image& seenCloud() const { return seenCloud_; }

    /// Records the split of the frame's background against `sky`.
    void recordSplit(gpu::Commands& commands, const frame::Frame& frame, const glm::vec3& sky);
    Present present() const;
    /// Records what makes of the filtered layers the part `part` of the frame as seen through the fog. A layer that is
    /// not present counts as black.
    void recordJoin(gpu::Commands& commands, const frame::Frame& frame, const Present& present, const OpenSky& open,
                    const Tile& part);

  private:
    gpu::Context& context_;
    gpu::Image shadow_, bright_, far_, seenCloud_;
    gpu::Buffer summary_;
    std::optional<gpu::Image> openSky_, ownLight_;
    gpu::Program<shared::FogSplitPush> split_;
    gpu::Program<shared::FogJoinPush> join_;
};

}  // namespace lumulus::fog
