#include "light/fog_light/legendre.h"

#include <cmath>

namespace lumulus::fog_light {

std::vector<double> legendre(int order, int count, double cosine) {
    std::vector<double> values(static_cast<std::size_t>(count), 0.0);
    const double sine = std::sqrt(std::fmax(0.0, 1.0 - cosine * cosine));
    double before = 0.0, value = 1.0;
    for (int m = 1; m <= order; ++m) value *= sine * std::sqrt((2.0 * m - 1.0) / (2.0 * m));
    const auto root = [&](double l) { return std::sqrt(l * l - order * order); };
    for (int l = order; l < count; ++l) {
        values[static_cast<std::size_t>(l)] = value;
        const double next = ((2.0 * l + 1.0) * cosine * value - root(l) * before) / root(l + 1.0);
        before = value;
        value = next;
    }
    return values;
}

}  // namespace lumulus::fog_light
