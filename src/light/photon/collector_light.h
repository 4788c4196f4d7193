#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/program.h"
#include "light/photon/map_part.h"
#include "shared/photon.h"

namespace lumulus::photon {

/// What the collectors of all clouds of a photon map send to an eye, made of the map's sums.
class CollectorLight {
  public:
    CollectorLight(gpu::Context& context, std::span<const MapPart> parts, int bands);

    /// Centre and ∫ σt' dV [m²] of each collector: voxel coordinates of the one cloud, or metres in the world.
    void setPlaces(std::span<const glm::vec4> places);
    /// Records the reconstruction. `push` without what depends on the media.
    void record(gpu::Commands& commands, const gpu::Buffer& sum, shared::ReconstructPush push) const;

    /// At collectorTexel(): RGB and 1; flux and fluence of the luminance, and fluence of RGB, whatever the eye.
    const gpu::Image& radiance() const { return radiance_; }
    const gpu::Image& fluences() const { return fluences_; }
    const gpu::Image& colours() const { return colours_; }

  private:
    gpu::Context& context_;
    std::uint32_t collectors_;
    float angleScale_;
    gpu::Program<shared::ReconstructPush> program_;
    gpu::Buffer moments_, media_, axisTables_, places_;
    gpu::Image fluences_, colours_, radiance_;
};

}  // namespace lumulus::photon
