#include "fog/screen/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "medium/fog_media.h"

namespace lumulus::fog {

namespace {

/// The largest ϱ of an exponential layer: at its bottom, or at its top where it is denser upwards. The axis is
/// vertical.
double densestPlace(const shared::FogMedium& medium) {
    const float toFace = medium.axis.y > 0.0F ? medium.aboveBottom : medium.belowTop;
    return std::exp(std::min(
        -static_cast<double>(medium.falloff) * (static_cast<double>(medium.eyeHeight) - static_cast<double>(toFace)),
        80.0));
}

/// A bound of ∫ϱ over every path of that length that starts at the eye.
double densestPath(shared::FogMedium medium, float distance, float skyDistance) {
    const auto length = static_cast<double>(medium.bounded != 0 ? distance : std::min(distance, skyDistance));
    if (medium.kind == shared::MEDIUM_HOMOGENEOUS) return length;
    if (medium.kind == shared::MEDIUM_SPHERE) return std::min(length, 4.0 / 3.0 * static_cast<double>(medium.radius));
    if (medium.kind == shared::MEDIUM_ELLIPSOID || medium.kind == shared::MEDIUM_BOX)
        return std::min(length, 2.0 * glm::length(glm::dvec3(medium.halfSize)));
    const bool level = medium.axis.x == 0.0F && medium.axis.z == 0.0F;
    const double most = level ? length * densestPlace(medium) : std::numeric_limits<double>::infinity();
    medium.aboveBottom = medium.belowTop = medium.thickness = shared::ENDLESS;
    return std::min(most, static_cast<double>(
                              shared::densityIntegral(medium, glm::vec3(0.0F), -medium.axis, distance, skyDistance)));
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
