#include "light/fog_light/fog_sources.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::fog_light {

namespace {

using std::numbers::pi;

/// A sun lower than this counts as standing so low.
constexpr double lowestSine = 1e-3;
/// Azimuths at which the sky is looked at, from the sun's to the one opposite to it.
constexpr int skyAzimuths = 64;

/// A mode of the sky's radiance, by stream.
Vector skyMode(const std::vector<glm::dvec3>& sky, int mode, int channel) {
    Vector made(static_cast<std::size_t>(streamCount), 0.0);
    for (std::size_t at = 0; at < sky.size(); ++at) {
        const double azimuth = pi * (static_cast<double>(at % skyAzimuths) + 0.5) / skyAzimuths;
        made[at / skyAzimuths] += (mode == 0 ? 1.0 : 2.0) / skyAzimuths * sky[at][channel] * std::cos(mode * azimuth);
    }
    return made;
}

}  // namespace

double sunSine(const FogSetting& setting) {
    return std::max(lowestSine, setting.toSun.y);
}

glm::dvec3 sunAbove(const FogSetting& setting) {
    return setting.toSun.y > 0.0 ? setting.sun : glm::dvec3(0.0);
}

SkyLight skyLight(const FogSetting& setting) {
    SkyLight light;
    if (!setting.skyAt) return light;
    for (const double cosine : makeStreams().cosines)
        for (int i = 0; i < skyAzimuths; ++i) {
            const double azimuth = pi * (i + 0.5) / skyAzimuths;
            light.above.push_back(setting.skyAt(cosine, azimuth));
            light.below.push_back(setting.groundHeight ? glm::dvec3(0.0) : setting.skyAt(-cosine, azimuth));
        }
    return light;
}

Incoming incomingOf(const FogSetting& setting, const SkyLight& sky, int mode, int channel) {
    if (setting.skyAt) return {skyMode(sky.above, mode, channel), skyMode(sky.below, mode, channel)};
    const double radiance = mode == 0 ? setting.sky[channel] : 0.0;
    return {Vector(static_cast<std::size_t>(streamCount), radiance),
            Vector(static_cast<std::size_t>(streamCount), setting.groundHeight ? 0.0 : radiance)};
}

glm::dvec3 irradianceAbove(const std::vector<FogLayer>& layers, const FogSetting& setting) {
    const std::vector<double> levels = levelsOf(layers, setting.groundHeight);
    const SkyLight sky = skyLight(setting);
    const Streams streams = makeStreams();
    glm::dvec3 rising(0.0);
    for (int channel = 0; channel < 3; ++channel) {
        const Stack stack = makeStack(layers, levels, channel);
        const ModeTransport transport(
            stack, 0, setting.groundHeight ? std::optional(setting.groundAlbedo[channel]) : std::nullopt);
        const Beam beam{sunAbove(setting)[channel], sunSine(setting)};
        const Incoming incoming = incomingOf(setting, sky, 0, channel);
        const Radiance light = transport.radiance(transport.solve(beam, incoming), beam, incoming);
        const auto count = static_cast<std::size_t>(streamCount);
        for (std::size_t j = 0; j < count; ++j)
            rising[channel] +=
                2.0 * pi * streams.weights[j] * streams.cosines[j] * light.up[(levels.size() - 1) * count + j];
    }
    return rising;
}

}  // namespace lumulus::fog_light
