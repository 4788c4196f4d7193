#include "sky/optical_depth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sky/shell.h"

namespace lumulus::sky {

namespace {

const double topDistance = std::sqrt(airTop * (2.0 * planetRadius + airTop));  // from the ground along the horizon

/// Columns from a point upwards, where the air only gets thinner: Gauss's rule of three points in the root of the
/// distance.
glm::dvec3 upwards(double height, double up) {
    constexpr std::array<double, 3> places{0.11270166537925831, 0.5, 0.88729833462074169};
    constexpr std::array<double, 3> weights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    constexpr int panels = 32;
    const double length = distanceToTop(height, up);
    glm::dvec3 sum(0.0);
    for (int panel = 0; panel < panels; ++panel)
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double x = (panel + places[i]) / panels;
            const AirDensity air = airDensity(heightAlong(height, up, length * x * x));
            sum += (weights[i] * 2.0 * x) * glm::dvec3(air.molecules, air.aerosol, air.ozone);
        }
    return sum * (length / panels);
}

}  // namespace

glm::dvec3 ColumnTable::integrate(double height, double up) {
    if (up >= 0.0) return upwards(height, up);
    // from the ray's lowest point to both sides
    const double r = planetRadius + height, sine2 = std::max(0.0, 1.0 - up * up);
    // r sin − R, without cancellation
    const double lowest =
        std::max(0.0, (height * (planetRadius + r) - r * r * up * up) / (planetRadius + r * std::sqrt(sine2)));
    return 2.0 * upwards(lowest, 0.0) - upwards(height, -up);
}

ColumnTable::ColumnTable() : columns_(static_cast<std::size_t>(across) * down) {
    tbb::parallel_for(0, down, [&](int row) {
        const double rho = topDistance * row / (down - 1.0);
        const double height = rho * rho / (planetRadius + std::sqrt(planetRadius * planetRadius + rho * rho));
        const double least = airTop - height, most = rho + topDistance;
        for (int i = 0; i < across; ++i) {
            const double d = least + (most - least) * i / (across - 1.0);
            const double r = planetRadius + height;
            const double up = d > 0.0 ? (topDistance * topDistance - rho * rho - d * d) / (2.0 * r * d) : 1.0;
            columns_[static_cast<std::size_t>(row * across + i)] =
                integrate(std::min(height, airTop), std::clamp(up, horizonCosine(height), 1.0));
        }
    });
}

glm::dvec3 ColumnTable::toTop(double height, double up) const {
    const double rho = std::sqrt(std::max(0.0, height * (2.0 * planetRadius + height)));
    const double least = airTop - height, most = rho + topDistance;
    if (!(least > 0.0)) return glm::dvec3(0.0);
    const double d = std::clamp(distanceToTop(height, up), least, most);
    const double x = (d - least) / (most - least) * (across - 1.0), y = rho / topDistance * (down - 1.0);
    const int column = std::clamp(static_cast<int>(x), 0, across - 2),
              row = std::clamp(static_cast<int>(y), 0, down - 2);
    const double fx = x - column, fy = y - row;
    const glm::dvec3* const at = &columns_[static_cast<std::size_t>(row * across + column)];
    return (1.0 - fy) * ((1.0 - fx) * at[0] + fx * at[1]) + fy * ((1.0 - fx) * at[across] + fx * at[across + 1]);
}

}  // namespace lumulus::sky
