#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lumulus::bench {

/// What a picture costs: a part that does not depend on the photons, and a part for each of them. Seconds.
struct Cost {
    double fixed = 0.0;
    double perPhoton = 0.0;
};

struct Timing {
    double photons = 0.0;
    double seconds = 0.0;
};

/// The line through two timings, `more` with more photons. Where noise makes it fall or meet the axis below zero, the
/// line through the origin and `more`.
Cost costFrom(const Timing& less, const Timing& more);

struct PhotonBudget {
    double seconds = 0.0;  ///< wanted
    std::int64_t photons = 0;
};

/// The numbers of photons that fill the budgets (seconds, in rising order), at least `fewest`. Budgets that only
/// `fewest` could meet count once.
std::vector<PhotonBudget> planPhotons(std::span<const double> budgets, const Cost& cost, std::int64_t fewest);

/// Budgets in rising order, each once. Errors: InputError where there are none or one is not above 0 and at most 1e6.
std::vector<double> orderedBudgets(std::vector<double> budgets);

/// `count` seeds from `first` on without the reference's own: a path tracer with the same seed would repeat the
/// reference's samples and look better than it is.
std::vector<std::uint64_t> seedsWithout(std::uint64_t first, int count, std::optional<std::uint64_t> reference);

}  // namespace lumulus::bench
