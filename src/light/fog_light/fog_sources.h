#pragma once

#include "light/fog_light/fog_light.h"
#include "light/fog_light/transport.h"

/// What comes into level fog from outside, as its transport takes it.
namespace lumulus::fog_light {

/// Cosine of the sun to the vertical; a low one counts as standing just above the horizon.
double sunSine(const FogSetting& setting);
/// Irradiance across the sun's light above the fog; none of a sun below the horizon.
glm::dvec3 sunAbove(const FogSetting& setting);

/// Radiance of a sky that differs by direction: [stream][azimuth], upwards and downwards. Empty for a constant one.
struct SkyLight {
    std::vector<glm::dvec3> above, below;
};
SkyLight skyLight(const FogSetting& setting);

/// A mode of it, or of the constant sky, in a channel.
Incoming incomingOf(const FogSetting& setting, const SkyLight& sky, int mode, int channel);

/// Irradiance of a plane that faces down at the highest level [W/m²].
glm::dvec3 irradianceAbove(const std::vector<FogLayer>& layers, const FogSetting& setting);

}  // namespace lumulus::fog_light
