#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "shared/instance.h"

namespace lumulus::cloud {

/// One image that holds the volumes of several instances, each in a slot of the largest one's size with a texel of
/// nothing around it, so that a shader which goes from instance to instance binds one resource. Volumes are copied.
class Atlas {
  public:
    /// Slots for volumes of these extents; a volume that stands in the list twice has one slot.
    /// Errors: Error where the image is above the device's limits.
    Atlas(gpu::Context& context, const char* name, std::span<const gpu::Image* const> volumes, VkFormat format);

    /// Records the copies.
    void record(gpu::Commands& commands, std::span<const gpu::Image* const> volumes) const;
    /// Whether the volumes still fit into the slots.
    bool holds(std::span<const gpu::Image* const> volumes) const;

    const gpu::Image& image() const { return *image_; }
    /// First texel of a volume.
    const glm::ivec3& origin(std::size_t volume) const { return origins_[volume]; }
    glm::vec3 inverseSize() const { return 1.0F / glm::vec3(image_->extent()); }

  private:
    glm::ivec3 slot_{1};
    std::vector<glm::ivec3> origins_;
    std::optional<gpu::Image> image_;
    gpu::Program<shared::CopyVolumePush> program_;
};

}  // namespace lumulus::cloud
