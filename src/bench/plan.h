#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lumulus::bench {

/// Cost of a picture in seconds: a part that does not depend on the photons, and a part for each photon.
struct Cost {
    double fixed = 0.0;
    double perPhoton = 0.0;
};

struct Timing {
    double photons = 0.0;
    double seconds = 0.0;
};

/// The line through two timings, of which `more` has more photons. If noise makes this line fall or start below zero,
/// the result is the line through the origin and `more`.
Cost costFrom(const Timing& less, const Timing& more);

struct PhotonBudget {
    double seconds = 0.0;  ///< wanted time
    std::int64_t photons = 0;
};

/// The numbers of photons that fill the budgets (seconds, in rising order), at least `fewest`. Budgets that are too
/// short even for `fewest` photons give one picture together.
std::vector<PhotonBudget> planPhotons(std::span<const double> budgets, const Cost& cost, std::int64_t fewest);

/// Sorts budgets and drops repetitions. Errors: InputError if there are none, or one is not above 0 and at most 1e6.
std::vector<double> orderedBudgets(std::vector<double> budgets);

/// Chooses `count` seeds from `first` on, without the reference's own seed: a path tracer with that seed would repeat
/// the reference's samples and seem better than it is.
std::vector<std::uint64_t> seedsWithout(std::uint64_t first, int count, std::optional<std::uint64_t> reference);

}  // namespace lumulus::bench
