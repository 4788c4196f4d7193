#pragma once

#include <functional>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "surface/mesh/mesh_surface.h"

namespace lumulus::surface {

/// Runs recorded commands and waits for them.
using RunGpu = std::function<void(const std::function<void(gpu::Commands&)>&)>;

/// Follows rays through meshes on the GPU.
class RayTracer {
  public:
    /// `scene` outlives this object. Errors: Error where memory runs out.
    RayTracer(gpu::Context& context, const MeshScene& scene);

    /// What each ray meets first, holes of masks left out. Rays whose `most` is not above `least` meet nothing.
    std::vector<shared::MeshHit> nearest(std::span<const shared::MeshRay> rays, const RunGpu& run, const Check& check);
    /// Whether each ray meets anything.
    std::vector<bool> blocked(std::span<const shared::MeshRay> rays, const RunGpu& run, const Check& check);

  private:
    void trace(std::span<const shared::MeshRay> rays, std::span<shared::MeshHit> hits, bool any, const RunGpu& run,
               const Check& check);

    const MeshScene& scene_;
    gpu::Program<shared::MeshPush> program_;
    gpu::Buffer nodes_, triangles_, instances_, rays_, hits_;
};

}  // namespace lumulus::surface
