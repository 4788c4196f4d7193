#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "gpu/commands.h"
#include "gpu/program.h"
#include "light/photon/photon_map.h"
#include "shared/ground.h"

namespace lumulus::photon {

/// The ground below the clouds as photons meet it. Two grids of cells lie over the same rectangle of it: one of
/// radiances, and one of GROUND_COUNTS² cells in which light that clouds send down is counted.
struct Ground {
    glm::dvec3 albedo{0.0};
    double height = 0.0;                ///< y [m]
    glm::dvec2 lower{0.0}, upper{1.0};  ///< corners of the rectangle, x and z [m]
    glm::ivec2 cells{0};                ///< of the radiances
    std::vector<glm::vec3> radiance;    ///< of the ground without the light of clouds, x fastest [W/(m² sr)]
    glm::dvec3 open{0.0}, sky{0.0};     ///< outside of the rectangle, and of the sky [W/(m² sr)]
    glm::dvec3 corner{0.0};             ///< where the walk's cells begin [m]

    /// What photons of the sky stand for: the brightest that ground and sky may be [W/(m² sr)].
    glm::dvec3 brightest() const { return glm::max(open, sky); }
};

/// Counts of the ground among those of a generation.
constexpr std::uint32_t groundCounts() {
    return 3U * static_cast<std::uint32_t>(shared::GROUND_COUNTS * shared::GROUND_COUNTS);
}

/// The ground on the GPU for the walk, and its way back.
class GroundWalk {
  public:
    /// `countBase`: where its counts begin among those of a generation.
    GroundWalk(gpu::Context& context, std::uint32_t countBase);

    /// The ground for the next generations, whose cells have these edges in the world (columns, metres).
    void set(const Ground& ground, const glm::dmat3& cellsToWorld);
    const gpu::Buffer& buffer() const { return *buffer_; }

    /// Light that has fallen on the cells [W], RGB, x fastest.
    std::vector<glm::vec3> download(const Light& light);

  private:
    gpu::Context& context_;
    std::uint32_t countBase_;
    gpu::Program<shared::GroundCountsPush> program_;
    std::optional<gpu::Buffer> buffer_;
    gpu::Buffer watts_;
    gpu::Commands commands_;
};

}  // namespace lumulus::photon
