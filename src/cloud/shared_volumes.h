#pragma once

#include <memory>
#include <optional>
#include <span>

#include "cloud/atlas.h"
#include "cloud/bricks.h"
#include "cloud/instance.h"

namespace lumulus::cloud {

/// The volumes of the assets of several instances, in one image each, for shaders that go from instance to instance.
/// Densities are all dense, and copied into an atlas, or all in bricks, which lie in one pool already.
class SharedVolumes {
  public:
    /// `instances` have assets. Errors: Error where a volume does not fit into an image of the device.
    SharedVolumes(gpu::Context& context, std::span<const Instance* const> instances);

    bool sparse() const { return pool_ != nullptr; }
    const gpu::Image& density() const { return sparse() ? *pool_ : densities_->image(); }
    /// Index of the bricks; any image of integers where densities are dense.
    const gpu::Image& brickIndex() const { return sparse() ? bricks_->image : collectors_->image(); }
    const gpu::Image& collectorIndex() const { return sparse() ? nodes_->image : collectors_->image(); }
    const Atlas& majorants() const { return *majorants_; }
    /// Reciprocal of the atlas of densities [1/texels].
    glm::vec3 inverseSize() const { return sparse() ? glm::vec3(0.0F) : densities_->inverseSize(); }
    /// Where an instance's density begins, in the order of the instances: the first texel in the atlas, or the numbers
    /// of the first texels in the indices of bricks and of collectors.
    glm::vec3 place(std::size_t instance) const;

  private:
    std::optional<Atlas> densities_, majorants_;
    std::optional<Atlas> collectors_;  ///< of each voxel, at the place of its density
    std::shared_ptr<const gpu::Image> pool_;
    std::optional<JoinedIndex> bricks_, nodes_;
};

}  // namespace lumulus::cloud
