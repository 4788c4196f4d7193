#pragma once

#include <optional>

#include "frame/frame.h"
#include "shared/frame.h"
#include "sky/map_sky.h"

namespace lumulus::frame {

/// Shows a map of the surroundings in a frame, behind the clouds. It keeps as much of the map as pixels of one viewer's
/// picture can show.
class MapPass {
  public:
    explicit MapPass(gpu::Context& context);

    /// Records the pass over a frame that shows the part `tile` of the camera's picture, whose radiance is that of the
    /// clouds alone. The map is the same every time.
    void record(gpu::Commands& commands, const Frame& frame, const sky::MapSky& map, const Camera& camera,
                const Tile& tile);

  private:
    void upload(const sky::MapSky& map, int width);

    gpu::Context& context_;
    gpu::Program<gpu::NoPush> program_;
    gpu::Buffer params_;
    std::optional<gpu::Image> image_;
    int width_ = 0;  ///< of the map in it, pixels
};

}  // namespace lumulus::frame
