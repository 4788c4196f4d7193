#include "reference/phase_values.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/constants.hpp>

namespace lumulus::reference {

PhaseValues::PhaseValues(std::vector<double> oneMinusCos, std::vector<double> values)
    : places_(std::move(oneMinusCos)), values_(std::move(values)), below_(places_.size(), 0.0) {
    for (std::size_t i = 1; i < places_.size(); ++i)
        below_[i] = below_[i - 1] + glm::pi<double>() * (places_[i] - places_[i - 1]) * (values_[i] + values_[i - 1]);
    const double whole = below_.back();
    for (double& value : values_) value /= whole;
    for (double& share : below_) share /= whole;
}

double PhaseValues::evaluate(double oneMinusCos) const {
    const auto next = std::upper_bound(places_.begin() + 1, places_.end() - 1, oneMinusCos);
    const auto i = static_cast<std::size_t>(next - places_.begin());
    const double part = (oneMinusCos - places_[i - 1]) / (places_[i] - places_[i - 1]);
    return values_[i - 1] + std::clamp(part, 0.0, 1.0) * (values_[i] - values_[i - 1]);
}

double PhaseValues::invert(double u) const {
    const auto next = std::upper_bound(below_.begin() + 1, below_.end() - 1, u);
    const auto i = static_cast<std::size_t>(next - below_.begin());
    const double width = places_[i] - places_[i - 1], low = values_[i - 1], rise = values_[i] - low;
    // low t + rise t²/2 = wanted, by the root that does not cancel
    const double wanted = (u - below_[i - 1]) / (glm::two_pi<double>() * width);
    const double root = std::sqrt(std::max(0.0, low * low + 2.0 * rise * wanted));
    const double t = low + root > 0.0 ? 2.0 * wanted / (low + root) : 0.0;
    return places_[i - 1] + width * std::clamp(t, 0.0, 1.0);
}

}  // namespace lumulus::reference
