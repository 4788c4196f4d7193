#pragma once

#include <span>
#include <vector>

#include "cloud/instance.h"
#include "draw/tiles.h"
#include "gpu/commands.h"
#include "shared/instance.h"

namespace lumulus::draw {

/// Which instances each tile of pixels may show, nearest first, for rays that go through several.
class InstanceTiles {
  public:
    /// Of all instances, as a camera sees them: they have assets. Uploads.
    InstanceTiles(gpu::Context& context, std::span<const cloud::Instance* const> instances, const Camera& camera);
    /// Stands for the lists where there is one instance: shaders never read it, but bindings must be there.
    explicit InstanceTiles(gpu::Context& context);

    int across() const { return across_; }
    /// Whether a pixel may show an instance.
    bool isListed(std::size_t instance) const { return listed_[instance]; }
    void addBindings(std::vector<gpu::Binding>& bindings) const;

  private:
    InstanceTiles(gpu::Context& context, const TileLists& tiles, std::span<const std::uint32_t> lists,
                  std::span<const glm::vec4> places);

    int across_ = 0;
    std::vector<bool> listed_;
    gpu::Buffer offsets_, lists_, places_;
};

}  // namespace lumulus::draw
