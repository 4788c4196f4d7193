#include "sky/sun_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/shell.h"

namespace lumulus::sky {

double visibleShare(double height, double up, double radius, double& middle) {
    middle = up;
    const double horizon = horizonCosine(height);
    // far from the horizon, without inverse functions: |Δ cos| ≥ |Δ angle| · least sine
    if (up - horizon > radius) return 1.0;
    const double above = std::asin(std::clamp(up, -1.0, 1.0)) - std::asin(horizon);
    if (above >= radius) return 1.0;
    if (above <= -radius) return 0.0;
    middle = std::sin(std::asin(horizon) + 0.5 * (above + radius));
    const double x = above / radius;
    return 1.0 - (std::acos(x) - x * std::sqrt(1.0 - x * x)) / std::numbers::pi;
}

Spectrum sunTransmittance(const Air& air, const ColumnTable& columns, double height, double up, double radius) {
    if (height >= airTop) {
        // above the air: straight, or along the other side of the ray's lowest point
        double middle = up;
        const double share = visibleShare(height, up, radius, middle);
        const double entry = share > 0.0 ? distanceToAir(height, middle) : 0.0;
        if (!(share > 0.0) || !std::isfinite(entry)) return Spectrum(share);
        const double r = planetRadius + height, top = planetRadius + airTop;
        const double upThere = (r * middle + entry) / top;
        return share * glm::exp(-opticalDepth(air, columns.toTop(airTop - 1e-3, upThere)));
    }
    double middle = up;
    const double share = visibleShare(height, up, radius, middle);
    if (!(share > 0.0)) return Spectrum(0.0);
    return share * glm::exp(-opticalDepth(air, columns.toTop(height, middle)));
}

}  // namespace lumulus::sky
