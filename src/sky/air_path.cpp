#include "sky/air_path.h"

#include <algorithm>
#include <cmath>

#include "sky/path_steps.h"
#include "sky/shell.h"

namespace lumulus::sky {

AirPath makeAirPath(const Air& air, double height, double up, double length, int steps) {
    AirPath path;
    double begin = 0.0;
    AirPoint inside{height, up, 0.0, 0.0};
    if (height > airTop) {
        begin = distanceToAir(height, up);
        if (!(begin < length)) return path;
        inside = inside.after(begin);
        inside.height = std::min(inside.height, airTop);
    }
    const double end = std::min(length - begin, distanceToTop(inside.height, inside.up));
    const PathSteps places(end, -(planetRadius + inside.height) * inside.up, steps);
    path.steps.resize(static_cast<std::size_t>(steps));
    for (int i = 0; i < steps; ++i) {
        AirStep& step = path.steps[static_cast<std::size_t>(i)];
        const AirPoint p = inside.after(places.middle(i));
        step.distance = begin + places.middle(i);
        step.height = p.height;
        step.up = p.up;
        step.density = airDensity(p.height);
        const Spectrum extinction = air.extinction(step.density);
        const Spectrum through = glm::exp(-extinction * places.length(i));
        step.weight = path.transmittance * (1.0 - through) / glm::max(extinction, Spectrum(1e-30));
        path.transmittance *= through;
    }
    return path;
}

AirPoint pointOf(const AirPoint& from, const AirStep& step) {
    const double sun =
        ((planetRadius + from.height) * from.sun + step.distance * from.toSun) / (planetRadius + step.height);
    return {step.height, step.up, std::clamp(sun, -1.0, 1.0), from.toSun};
}

}  // namespace lumulus::sky
