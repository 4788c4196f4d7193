#include "fog/media.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::fog {

namespace {

int kindOf(scene::MediumKind kind) {
    switch (kind) {
        case scene::MediumKind::exponential:
            return shared::MEDIUM_EXPONENTIAL;
        case scene::MediumKind::sphere:
            return shared::MEDIUM_SPHERE;
        case scene::MediumKind::homogeneous:
            break;
    }
    return shared::MEDIUM_HOMOGENEOUS;
}

/// A bound of ∫ϱ over every path of that length that starts at the eye.
double densestPath(const shared::FogMedium& medium, float distance, float skyDistance) {
    if (medium.kind == shared::MEDIUM_SPHERE)
        return std::min(static_cast<double>(distance), 4.0 / 3.0 * static_cast<double>(medium.radius));
    const glm::vec3 steepest = medium.kind == shared::MEDIUM_EXPONENTIAL ? -medium.axis : glm::vec3(0, 0, 1);
    return static_cast<double>(shared::densityIntegral(medium, glm::vec3(0.0F), steepest, distance, skyDistance));
}

}  // namespace

std::vector<shared::FogMedium> mediaAround(const scene::Fog& fog, const glm::dvec3& eye) {
    std::vector<shared::FogMedium> media;
    for (const scene::FogMedium& from : fog.media) {
        shared::FogMedium medium{};
        medium.kind = kindOf(from.kind);
        medium.scattering = glm::vec3(from.scattering);
        medium.absorption = glm::vec3(from.absorption);
        medium.emission = glm::vec3(from.emission);
        medium.g = static_cast<float>(from.g);
        medium.axis = glm::vec3(from.direction);
        medium.falloff = static_cast<float>(from.falloff);
        medium.eyeHeight = static_cast<float>(glm::dot(eye - from.offset, from.direction));
        medium.center = glm::vec3(from.center - eye);
        medium.radius = static_cast<float>(from.radius);
        media.push_back(medium);
    }
    return media;
}

glm::dvec3 sunTransmittance(const scene::Fog& fog, const glm::dvec3& point, const glm::dvec3& directionTo) {
    shared::FogPath path = shared::clearPath();
    for (const shared::FogMedium& medium : mediaAround(fog, point)) {
        shared::addMedium(path, medium,
                          shared::densityIntegral(medium, glm::vec3(0.0F), glm::vec3(directionTo), shared::FAR_DEPTH,
                                                  static_cast<float>(fog.skyDistance)));
    }
    return glm::dvec3(shared::attenuatedShare(path));
}

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
