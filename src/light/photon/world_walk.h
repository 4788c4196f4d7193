#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cloud/merged_grid.h"
#include "cloud/shared_volumes.h"
#include "gpu/commands.h"
#include "light/photon/entry_discs.h"
#include "light/photon/map_part.h"
#include "shared/photon.h"

namespace lumulus::photon {

/// What photons walk through where there are several clouds: the merged grid, the clouds as the walk needs them, and
/// the discs round which photons begin. Made anew where a cloud has moved against the others or its extinction has
/// changed.
class WorldWalk {
  public:
    /// `parts` and `volumes` (of their assets, in the same order) outlive it.
    WorldWalk(gpu::Context& context, std::span<const MapPart> parts, const cloud::SharedVolumes& volumes);

    /// Where the clouds are now, one for each part.
    void place(std::span<const Placement> places);

    std::span<const std::uint32_t> spirv() const;
    /// `air`: light of an atmosphere.
    std::vector<gpu::SpecConstant> constants(bool air) const;
    /// Fills in what tracing needs to know of the grid.
    void setParams(shared::TraceParams& params) const;
    /// What the program binds beside what all walks bind.
    std::vector<gpu::Binding> bindings() const;
    /// What the program binds that finds where photons begin.
    std::vector<gpu::Binding> entryBindings() const;
    /// Photons that an invocation may begin in the next round.
    void setStarts(std::uint32_t starts) const;

    /// Area that a photon may stand for at most [m²].
    double largestWeight() const { return largestWeight_; }
    /// Area that photons which begin round a part stand for, on average over directions [m²].
    double meanWeight(std::size_t part) const { return meanWeights_[part]; }
    /// Sum of the areas that the clouds show at most [m²].
    double area() const { return area_; }
    /// Where lengths of the walk begin [m]; it moves with the first cloud.
    const glm::dvec3& corner() const { return grid_.origin; }
    /// Edge of its cells [m].
    double cellEdge() const { return grid_.edge; }
    std::uint64_t gridBytes() const { return grid_.bytes(); }

  private:
    void makeInstances(std::span<const Placement> places);
    void makeDiscs(std::span<const Placement> places);

    gpu::Context& context_;
    std::span<const MapPart> parts_;
    const cloud::SharedVolumes& volumes_;
    std::vector<Ellipsoid> ellipsoids_;
    std::vector<float> inverseCdfs_;
    std::vector<int> phaseTables_;  ///< where the inverse CDF of each part begins; −1: none
    std::vector<Placement> madeFor_;
    cloud::MergedGrid grid_;
    double largestWeight_ = 0.0, area_ = 0.0;
    std::vector<double> meanWeights_;
    gpu::Buffer inverseCdf_, gridParams_;
    std::optional<gpu::Buffer> bricks_, cells_, lists_, instances_, discs_, entries_;
};

}  // namespace lumulus::photon
