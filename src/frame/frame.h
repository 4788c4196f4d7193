#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "base/image.h"
#include "gpu/commands.h"
#include "shared/frame.h"
#include "view/view.h"

namespace lumulus::frame {

/// Layers of a picture on the GPU. Passes write and read them there, and the host reads the finished picture once.
/// Errors: Error where memory runs out or an image of this size is above the device's limit.
class Frame {
  public:
    /// `size` in pixels. The layers hold nothing until recordBackground() and recordBand() have filled them.
    Frame(gpu::Context& context, const glm::ivec2& size);

    const glm::ivec2& size() const { return size_; }
    /// RGB: light of the cloud (layers cloud.R, G, B); alpha: how much of the pixel the cloud covers (layer cloud.A).
    const gpu::Image& cloud() const { return cloud_; }
    /// RGB: all that is seen (layers R, G, B); alpha: transmittance of the cloud.
    const gpu::Image& radiance() const { return radiance_; }
    /// Mean distance of the cloud along the ray in metres (layer depth.Z); shared::FAR_DEPTH where none is.
    const gpu::Image& depth() const { return depth_; }

    /// Records what is seen without a cloud everywhere but in the rectangle `without`: a sky of that radiance.
    void recordBackground(gpu::Commands& commands, const glm::vec3& sky, const Tile& without) const;
    /// Records the sun's disc, as seen through the clouds, after all else; not without pixels.
    void recordSun(gpu::Commands& commands, const std::vector<shared::SunPixel>& sunPixels);
    /// Records the copy of drawn pixels, texels in a buffer row by row, into the rectangle `place`.
    void recordBand(gpu::Commands& commands, const gpu::Buffer& pixels, const Tile& place) const;
    /// Reads a part of the picture with all its layers. Adds the times of the passes to `times`.
    LayeredImage download(gpu::Commands& commands, const Tile& part, std::vector<gpu::PassTime>& times) const;

  private:
    gpu::Context& context_;
    glm::ivec2 size_;
    gpu::Image cloud_, radiance_, depth_, front_;
    gpu::Program<shared::BackgroundPush> background_;
    gpu::Program<shared::SunPixelsPush> sun_;
    gpu::Program<shared::BandPush> write_, read_;
    std::optional<gpu::Buffer> sunPixels_;  ///< of the last recordSun(), until its commands are done
};

}  // namespace lumulus::frame
