#pragma once

#include <glm/glm.hpp>

#include "cloud/cloud.h"
#include "gpu/commands.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// In-scattered radiance towards the eye as a smooth field: the collectors' values, weighted by mass, on a coarse grid.
/// Collectors drawn one by one would show as blocks, and their noise as grain.
class LightField {
  public:
    /// `photons` of the whole map: the more there are, the finer the grid.
    LightField(gpu::Context& context, const cloud::Cloud& cloud, std::uint64_t photons);

    /// Records what fills the grid from the collectors' radiance (vec3 each).
    void record(gpu::Commands& commands, const gpu::Buffer& radiance) const;

    /// (Σ ρ L, Σ ρ), to be divided after the look-up.
    const gpu::Image& image() const { return image_; }
    /// Voxel coordinates → texture coordinates.
    glm::vec3 scale() const;

  private:
    const cloud::Cloud& cloud_;
    shared::LightFieldPush push_;
    gpu::Program<shared::LightFieldPush> cellsProgram_, smoothProgram_;
    gpu::Image cells_, image_;
};

}  // namespace lumulus::draw
