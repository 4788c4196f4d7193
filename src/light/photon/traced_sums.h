#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "light/photon/photon_map.h"

namespace lumulus::photon {

/// Generations of photons that follow each other.
struct GenerationRange {
    std::uint64_t first = 0, count = 0;

    std::uint64_t end() const { return first + count; }
    bool operator==(const GenerationRange&) const = default;
};

/// What generations have left in a map without a ring: integers in a unit that depends on the lights alone, so that the
/// sum of any parts is that of the whole, to the bit.
struct TracedSums {
    std::vector<GenerationRange> generations{};  ///< which, in their order, apart from each other
    std::uint64_t photonsEach = 0;               ///< of a generation
    std::optional<int> unitExponent{};           ///< a count stands for so many powers of two [W]; none: without light
    double flux = 0.0;                           ///< of the lights, luminance [W]
    glm::dvec3 sunDirection{0.0};                ///< of travel
    Counters counters{};
    std::vector<std::int64_t> counts{};  ///< as PhotonMap has them

    std::uint64_t generationsTraced() const {
        std::uint64_t sum = 0;
        for (const GenerationRange& range : generations) sum += range.count;
        return sum;
    }
};

}  // namespace lumulus::photon
