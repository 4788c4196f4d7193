#include "light/light_set.h"

#include "medium/fog_media.h"

namespace lumulus::light {

scene::Sun LightSet::sunAt(const glm::dvec3& point, const scene::Fog& fog) const {
    scene::Sun reaching = sun;
    if (!fog.media.empty()) reaching.irradiance *= fog::sunTransmittance(fog, point, sun.directionTo);
    reaching.irradiance *= environment.sunTransmittance(point, sun.directionTo);
    return reaching;
}

const sky::SkyMaps& LightSet::skyMaps(const glm::dvec3& place) {
    if (!skyMaps_ || !skyMaps_->isOf(place, sun)) skyMaps_.emplace(*environment.atmosphere(), place, sun);
    return *skyMaps_;
}

}  // namespace lumulus::light
