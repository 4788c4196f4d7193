#pragma once

#include <cstdint>
#include <memory>

#include "render/renderer.h"
#include "scene/scene.h"

namespace lumulus {

/// Densities that a renderer has prepared, on the host: another renderer, on a device of its own, takes them without
/// loading them again.
class DensityCopies {
  public:
    DensityCopies();
    DensityCopies(DensityCopies&&) noexcept;
    DensityCopies& operator=(DensityCopies&&) noexcept;
    ~DensityCopies();

    bool empty() const;

  private:
    friend class ShownDensities;
    struct State;
    std::unique_ptr<State> state_;
};

/// The densities that a renderer shows, as far as others can take them: dense fields in whole voxels. Used by the
/// thread that uses the renderer, and gone no later than the device.
class ShownDensities {
  public:
    ShownDensities();
    ShownDensities(const ShownDensities&) = delete;
    ShownDensities& operator=(const ShownDensities&) = delete;
    ~ShownDensities();

    /// Makes a renderer of the scene and notes what it shows. It takes the copies, where the scene shows these
    /// densities and would prepare them in the same way; pictures have the same bits with them and without.
    /// `options.read` and `options.kept` are set here, and `options.context` where there are copies. Errors: those of
    /// Renderer.
    std::unique_ptr<Renderer> makeRenderer(const scene::Scene& scene, RendererOptions options, DensityCopies copies);

    /// Bytes on the host of copies of all that the scene shows too.
    std::uint64_t copyBytes(const scene::Scene& scene) const;
    /// Adds to the copies of what the scene shows too: `bytes` of texels at least, which are read back from the device,
    /// or all. Returns whether it is all. The scene is the same for all parts of one copy.
    bool copy(const scene::Scene& scene, DensityCopies& copies, std::uint64_t bytes) const;

  private:
    std::unique_ptr<Renderer> make(const scene::Scene& scene, const RendererOptions& options);
    void forgetValues();

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lumulus
