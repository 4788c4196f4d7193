#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "shared/instance.h"

namespace lumulus::cloud {

/// One image that holds the volumes of several instances, each with a texel of nothing beside it, so that a
/// shader which goes from instance to instance binds one resource. Volumes are copied.
class Atlas {
  public:
    /// Room for volumes of these extents; a volume that stands in the list twice has one place.
    /// Errors: Error where the image is above the device's limits.
    Atlas(gpu::Context& context, const char* name, std::span<const gpu::Image* const> volumes, VkFormat format);

    /// Records the copies.
    void record(gpu::Commands& commands, std::span<const gpu::Image* const> volumes) const;
    /// Whether the volumes still have the extents that there is room for.
    bool holds(std::span<const gpu::Image* const> volumes) const;

    const gpu::Image& image() const { return *image_; }
    /// First texel of a volume.
    const glm::ivec3& origin(std::size_t volume) const { return origins_[volume]; }
    glm::vec3 inverseSize() const { return 1.0F / glm::vec3(image_->extent()); }

  private:
    std::vector<glm::ivec3> origins_, extents_;  ///< of each volume
    std::optional<gpu::Image> image_;
    gpu::Program<shared::CopyVolumePush> program_;
};

}  // namespace lumulus::cloud
