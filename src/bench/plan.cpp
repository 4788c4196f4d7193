#include "bench/plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace lumulus::bench {

Cost costFrom(const Timing& less, const Timing& more) {
    const double slope = (more.seconds - less.seconds) / (more.photons - less.photons);
    const double fixed = less.seconds - slope * less.photons;
    if (slope > 0.0 && fixed >= 0.0) return {fixed, slope};
    return {0.0, more.seconds / more.photons};
}

std::vector<PhotonBudget> planPhotons(std::span<const double> budgets, const Cost& cost, std::int64_t fewest) {
    constexpr double most = 1e12;  // the limit of scene files
    std::vector<PhotonBudget> plan;
    for (const double seconds : budgets) {
        const double photons = std::min(most, (seconds - cost.fixed) / cost.perPhoton);
        const PhotonBudget budget{seconds, std::max(fewest, static_cast<std::int64_t>(photons + 0.5))};
        if (!plan.empty() && plan.back().photons == budget.photons) continue;
        plan.push_back(budget);
    }
    return plan;
}

std::vector<double> orderedBudgets(std::vector<double> budgets) {
    constexpr double longest = 1e6;
    if (budgets.empty()) throw InputError("no budget is given", "--seconds", "give budgets such as 0.3,1,3");
    for (const double seconds : budgets) {
        if (seconds > 0.0 && seconds <= longest) continue;
        throw InputError(fmt::format("the budget of {} seconds is out of range", seconds), "--seconds",
                         "give times above 0, up to 1e6");
    }
    std::ranges::sort(budgets);
    budgets.erase(std::ranges::unique(budgets).begin(), budgets.end());
    return budgets;
}

std::vector<std::uint64_t> seedsWithout(std::uint64_t first, int count, std::optional<std::uint64_t> reference) {
    std::vector<std::uint64_t> seeds;
    for (std::uint64_t seed = first; seeds.size() < static_cast<std::size_t>(count); ++seed) {
        if (seed != reference) seeds.push_back(seed);
    }
    return seeds;
}

}  // namespace lumulus::bench
