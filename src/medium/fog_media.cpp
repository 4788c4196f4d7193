#include "medium/fog_media.h"

#include <cmath>

#include "scene/fog_bounds.h"

namespace lumulus::fog {

namespace {

int kindOf(scene::MediumKind kind) {
    switch (kind) {
        case scene::MediumKind::exponential:
            return shared::MEDIUM_EXPONENTIAL;
        case scene::MediumKind::sphere:
            return shared::MEDIUM_SPHERE;
        case scene::MediumKind::ellipsoid:
            return shared::MEDIUM_ELLIPSOID;
        case scene::MediumKind::box:
            return shared::MEDIUM_BOX;
        case scene::MediumKind::homogeneous:
            break;
    }
    return shared::MEDIUM_HOMOGENEOUS;
}

float orEndless(double metres) {
    return std::isfinite(metres) ? static_cast<float>(metres) : shared::ENDLESS;
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
        medium.halfSize = glm::vec3(from.halfSize);
        medium.aboveBottom = orEndless(eye.y - from.bottom);
        medium.belowTop = orEndless(from.top - eye.y);
        medium.thickness = orEndless(from.top - from.bottom);
        medium.bounded = scene::isBounded(from) ? 1 : 0;
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

}  // namespace lumulus::fog
