#include "fog/screen/depth.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>

#include "shared/draw.h"

namespace lumulus::fog {

namespace {

/// Metres along the view's axis.
double planarOf(double z, const scene::Fog& fog) {
    const double divisor = fog.far - z * (fog.far - fog.near);
    return divisor > 0.0 ? fog.near * fog.far / divisor : static_cast<double>(shared::FAR_DEPTH);
}

}  // namespace

std::size_t depthToDistance(std::span<float> depth, const scene::Fog& fog, const Camera& camera) {
    std::atomic<std::size_t> bad = 0;
    const glm::dvec3 forward = camera.axes[2];
    tbb::parallel_for(0, camera.height, [&](int y) {
        std::size_t badInRow = 0;
        for (int x = 0; x < camera.width; ++x) {
            float& value = depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                                 static_cast<std::size_t>(x)];
            if (std::isnan(value) || value < 0.0F) ++badInRow;
            double distance = static_cast<double>(value);
            if (fog.depth == scene::FogDepth::zbuffer) distance = planarOf(distance, fog);
            const bool flat = camera.projection != scene::Projection::perspective;
            if (fog.depth != scene::FogDepth::distance && !flat)
                distance /= std::max(glm::dot(camera.ray(x + 0.5, y + 0.5).direction, forward), 1e-6);
            // the comparison also catches what is no number
            const bool near = distance < static_cast<double>(shared::FAR_DEPTH);
            value = near ? static_cast<float>(std::max(distance, 0.0)) : shared::FAR_DEPTH;
        }
        bad += badInRow;
    });
    return bad;
}

}  // namespace lumulus::fog
