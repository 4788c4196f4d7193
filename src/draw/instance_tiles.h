#pragma once

#include <span>
#include <vector>

#include "cloud/instance.h"
#include "draw/tiles.h"
#include "gpu/commands.h"
#include "shared/instance.h"

namespace lumulus::draw {

/// How finely an instance is to be drawn.
struct Fineness {
    int spacing = 1;  ///< of sampling points, pixels (samplingSpacing())
    int rays = 1;     ///< of a pixel, along each side
};

/// Which instances each tile of pixels may show, nearest first, for rays that go through several.
class InstanceTiles {
  public:
    /// Of all instances, as a camera sees them: they have assets. Uploads.
    InstanceTiles(gpu::Context& context, std::span<const cloud::Instance* const> instances,
                  std::span<const Fineness> fineness, const Camera& camera);
    /// Stands for the lists where there is one instance: shaders never read it, but bindings must be there.
    explicit InstanceTiles(gpu::Context& context);

    int across() const { return across_; }
    /// Whether a pixel may show an instance.
    bool isListed(std::size_t instance) const { return listed_[instance]; }
    /// Part of the tiles with instances in which every pixel is drawn.
    double pixelShare() const { return pixelShare_; }
    const gpu::Buffer& detail() const { return detail_; }
    void addBindings(std::vector<gpu::Binding>& bindings) const;

  private:
    InstanceTiles(gpu::Context& context, const TileLists& tiles, std::span<const glm::uvec2> lists,
                  std::span<const glm::vec4> places, std::span<const std::uint32_t> detail);

    int across_ = 0;
    std::vector<bool> listed_;
    double pixelShare_ = 0.0;
    gpu::Buffer offsets_, lists_, places_;
    gpu::Buffer detail_;  ///< of each tile (shared/draw.h)
};

}  // namespace lumulus::draw
