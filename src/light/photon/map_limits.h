#pragma once

#include <cstdint>

namespace lumulus::photon {

/// What a photon map keeps for its collectors.
struct MapSize {
    std::uint64_t collectors = 0;
    int bands = 5;
    int generations = 20;  ///< slots of the ring
    bool keepRing = false;
    bool splitGenerations = false;  ///< even and odd generations apart
    std::uint64_t estimates = 0;    ///< counts of them, and of rings about the sun's axis
};

/// Bytes of one generation: [collector][RGB][bands²] and [addEstimate], int64.
std::uint64_t generationBytes(const MapSize& size);

/// Bytes of all coefficients: a generation in the making, or one of each half, the sum, and the slots of the ring where
/// it is kept.
std::uint64_t mapBytes(const MapSize& size);

/// Collectors that take half of the memory that a map of this kind may have: the other half is for its estimates.
std::uint64_t mostCollectors(const MapSize& size, std::uint64_t budget, std::uint64_t largestBuffer);

/// Errors: InputError where the map needs more than `budget` bytes, or one generation more than the device's largest
/// buffer, with both numbers.
void requireMapFits(const MapSize& size, std::uint64_t budget, std::uint64_t largestBuffer);

/// Records of a generation so far; beyond 2³⁸ a coefficient, to which each adds less than 2²⁵ counts, might wrap.
/// Errors: Error beyond it.
void requireCountable(std::uint64_t records);

}  // namespace lumulus::photon
