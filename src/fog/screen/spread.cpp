#include "fog/screen/spread.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "medium/fog_media.h"

namespace lumulus::fog {

namespace {

/// A bound of ∫ϱ over every path of that length that starts at the eye.
double densestPath(const shared::FogMedium& medium, float distance, float skyDistance) {
    if (medium.kind == shared::MEDIUM_SPHERE)
        return std::min(static_cast<double>(distance), 4.0 / 3.0 * static_cast<double>(medium.radius));
    const glm::vec3 steepest = medium.kind == shared::MEDIUM_EXPONENTIAL ? -medium.axis : glm::vec3(0, 0, 1);
    return static_cast<double>(shared::densityIntegral(medium, glm::vec3(0.0F), steepest, distance, skyDistance));
}

}  // namespace

double pixelsPerRadian(const Camera& camera) {
    if (camera.projection == scene::Projection::orthographic) return camera.height / camera.orthographicHeight;
    if (camera.projection == scene::Projection::panorama) return camera.height / std::numbers::pi;
    return camera.height / (2.0 * camera.tanHalfFov);
}

double largestSpread(const scene::Fog& fog, const Camera& camera, double farthest) {
    const auto distance = static_cast<float>(farthest), sky = static_cast<float>(fog.skyDistance);
    double turning = 0.0;
    for (const shared::FogMedium& medium : mediaAround(fog, camera.position))
        turning += static_cast<double>(shared::luminance(medium.scattering) * (1.0F - medium.g)) *
                   densestPath(medium, distance, sky);
    double scale = pixelsPerRadian(camera);
    if (camera.projection == scene::Projection::orthographic) scale *= std::min(farthest, fog.skyDistance);
    return std::sqrt(turning / 8.0) * scale;
}

}  // namespace lumulus::fog
