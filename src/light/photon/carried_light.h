#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "light/photon/map_part.h"
#include "vdb/volume.h"

/// Light of one frame's photon map in that of the next, whose clouds have other densities.
namespace lumulus::photon {

/// Where the counts of one cloud in a map belong.
struct CarriedCloud {
    std::size_t number = 0;          ///< of the scene's cloud
    std::vector<glm::dvec3> places;  ///< of the collectors, in the cloud's own coordinates [m]
    std::vector<double> masses;      ///< ∫ σt' dV of each [m²]
    vdb::Affine toCloud;             ///< voxels → the cloud's own coordinates [m]
    glm::ivec3 size{0};              ///< voxels
    cloud::CellGrid cells;           ///< of the estimates
    std::vector<double> cellMasses;  ///< ∫ σt' dV of each [m²], x fastest
    std::uint32_t firstCollector = 0;
    std::uint32_t estimatorBase = 0;
};

/// Where all counts of a map belong.
struct CarriedPlan {
    std::vector<CarriedCloud> clouds;  ///< of all parts of the map, in their order
    int bands = 0;
    std::uint32_t axisBase = 0;  ///< where the rings about the sun's axis begin, in as many counts for each collector …
    std::uint32_t axisCounts = 0;  ///< … as this
    std::uint32_t groundBase = 0;  ///< where the counts of the ground begin, up to the end
    std::uint32_t counts = 0;      ///< of all
    double generations = 0.0;      ///< that the counts are the sum of
};

/// The way that what is at a place has come since the frame before; both in the cloud's own coordinates [m].
using Way = std::function<glm::dvec3(const glm::dvec3& place)>;

/// Whether `from` has the light of all clouds in `to`, in as many bands.
bool hasLightFor(const CarriedPlan& from, const CarriedPlan& to);

/// The counts of a map at `from` as counts at `to` that stand for so many generations, times `factor`. Light for each
/// m² of ∫ σt' dV goes along with what moves: a collector has the mean of the eight nearest that were there, weighted
/// by mass/(d² + ¼ d₃²) with d their distances and d₃ that of the third, and so that their middle is near; one that
/// lies where one of before lay has the light of that one alone. Cells have interpolated counts over interpolated
/// masses; those where there was no density have the light of the collectors round them. The ground keeps its counts.
/// `ways` of the clouds of `to`. `from` has light for `to`. Deterministic. Errors: what `check` throws, which several
/// threads ask at once.
std::vector<std::int64_t> carriedCounts(const CarriedPlan& from, std::span<const std::int64_t> counts,
                                        const CarriedPlan& to, std::span<const Way> ways, double generations,
                                        double factor, const Check& check = stopIfInterrupted);

}  // namespace lumulus::photon
