#include "light/light_set.h"

#include "medium/fog_media.h"

namespace lumulus::light {

scene::Sun LightSet::sunAt(const glm::dvec3& point, const scene::Fog& fog) const {
    scene::Sun reaching = direct();
    if (!fog.media.empty()) reaching.irradiance *= fog::sunTransmittance(fog, point, reaching.directionTo);
    if (ground && reaching.directionTo.y <= 0.0) reaching.irradiance = glm::dvec3(0.0);
    reaching.irradiance *= environment.sunTransmittance(point, reaching.directionTo);
    return reaching;
}

void LightSet::chooseDirect(const glm::dvec3& point) {
    const std::optional<scene::Sun>& moon = environment.moon();
    const auto light = [&](const scene::Sun& of) {
        return sky::photometric(of.irradiance * environment.sunTransmittance(point, of.directionTo));
    };
    moonLeads_ = moon && light(*moon) > light(sun);
}

const sky::SkyMaps& LightSet::skyMaps(const glm::dvec3& place, const glm::dvec2& heights) {
    const Above above{place, sun, moonLeads_, sky::SkyMaps::levelsOf(heights.x, heights.y)};
    if (above_ == above) return *skyMaps_;
    const sky::Atmosphere& air = *environment.atmosphere();
    skyMaps_.emplace(air, place, direct(), above.levels);
    if (environment.moon()) skyMaps_->add(air, moonLeads_ ? sun : *environment.moon());
    above_ = above;
    return *skyMaps_;
}

}  // namespace lumulus::light
