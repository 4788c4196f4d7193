#include "light/fog_light/air_over_fog.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "light/fog_light/fog_sources.h"
#include "sky/sky_maps.h"

namespace lumulus::fog_light {

namespace {

constexpr double moleculeHeight = 8000.0, aerosolHeight = 1200.0;  // as sky::airDensity()

/// Directions in the frame of the vertical and of the sun's azimuth.
glm::dmat3 axesOf(const glm::dvec3& toSun) {
    const glm::dvec2 level(toSun.x, toSun.z);
    const glm::dvec2 across = glm::length(level) > 1e-9 ? glm::normalize(level) : glm::dvec2(1.0, 0.0);
    return {{across.x, 0.0, across.y}, {0.0, 1.0, 0.0}, {-across.y, 0.0, across.x}};
}

FogLayer airLayer(Scatterer scatterer, const glm::dvec3& scattering, const glm::dvec3& extinction, double scale,
                  double bottom, double top) {
    FogLayer layer;
    layer.scatterer = scatterer;
    layer.scattering = glm::max(scattering, 0.0);
    layer.absorption = glm::max(extinction - scattering, 0.0);
    layer.g = 0.0;
    layer.falloff = 1.0 / scale;
    layer.offset = layer.bottom = bottom;
    layer.top = top;
    return layer;
}

/// Factor of the coefficients by which as much of the sun's light comes from the top to the ground as does through
/// round air, whose colours change on the way: on a long one thin air's coefficients take too much. Under a sun of 5°
/// that is 4 to 7 % of the light, under one of 20° a thousandth. `above`, `below`: the sun's light at both ends.
glm::dvec3 ofSlantPath(const std::vector<FogLayer>& layers, const glm::dvec3& above, const glm::dvec3& below,
                       double ground, double top, double sine) {
    glm::dvec3 factor(1.0);
    if (!(sine > 0.0)) return factor;
    for (int c = 0; c < 3; ++c) {
        double depth = 0.0;
        for (const FogLayer& layer : layers)
            depth += (layer.scattering[c] + layer.absorption[c]) * layer.column(ground, top) / sine;
        if (depth > 1e-6 && above[c] > 0.0 && below[c] > 0.0 && below[c] < above[c])
            factor[c] = std::clamp(std::log(above[c] / below[c]) / depth, 0.5, 1.5);
    }
    return factor;
}

}  // namespace

AirOverFog::AirOverFog(const sky::Atmosphere& atmosphere, const AirLights& lights, const std::vector<FogLayer>& fog,
                       const glm::dvec3& albedo, double highest, const Check& check)
    : atmosphere_(atmosphere),
      lights_(lights),
      fog_(fog),
      albedo_(albedo),
      top_(levelsOf(fog, atmosphere.groundHeight()).back()),
      highest_(highest) {
    addEyes({top_}, check);
    albedoOfFog_ = albedoAbove();
    atmosphere_ = atmosphere.withGround(albedoOfFog_);
    eyes_.clear();
    addPlanes(check);
    std::vector<double> heights{top_};
    for (const double level : sky::SkyMaps::heights) {
        const double height = atmosphere.groundHeight() + level;
        if (height > top_ && height < highest) heights.push_back(height);
    }
    if (highest > top_) heights.push_back(highest);
    addEyes(heights, check);
}

void AirOverFog::addEyes(const std::vector<double>& heights, const Check& check) {
    for (const double height : heights) {
        check();
        const glm::dvec3 eye = atmosphere_.aboveFoot(height - atmosphere_.groundHeight());
        Eye& made = eyes_.emplace_back(Eye{height, {}});
        made.views.push_back(skyFrom(eye, lights_.direct));
        if (lights_.other) made.views.push_back(skyFrom(eye, *lights_.other));
    }
}

/// Most of the air is below this height above the fog [m].
constexpr double planeHeight = 25e3;

void AirOverFog::addPlanes(const Check& check) {
    if (!(lights_.direct.directionTo.y > 0.0)) return;
    FogSetting light;
    light.toSun = lights_.direct.directionTo;
    light.sun = lights_.direct.irradiance * sunAt(top_ + planeHeight);
    light.groundHeight = atmosphere_.groundHeight();
    light.groundAlbedo = albedoOfFog_;
    const std::vector<FogLayer> air = layersUpTo(top_ + planeHeight);
    withGround_.emplace(air, light, check);
    std::vector<FogLayer> all = fog_;
    all.insert(all.end(), air.begin(), air.end());
    light.groundAlbedo = albedo_;
    withFog_.emplace(all, light, check);
}

/// Light that comes from above with the fog, over that with the ground that counts for it.
glm::dvec3 AirOverFog::changeOfSky(double height, double up, double azimuth) const {
    if (!withFog_) return glm::dvec3(1.0);
    const double sine = std::max(up, 1e-3), level = std::sqrt(std::max(0.0, 1.0 - sine * sine));
    const glm::dvec3 direction =
        axesOf(lights_.direct.directionTo) * glm::dvec3(level * std::cos(azimuth), sine, level * std::sin(azimuth));
    const double at = std::clamp(height, top_, top_ + 0.9 * planeHeight);
    const glm::dvec3 fog = withFog_->radiance(at, direction), ground = withGround_->radiance(at, direction);
    return glm::clamp(fog / glm::max(ground, glm::dvec3(1e-30)), glm::dvec3(0.5), glm::dvec3(2.0));
}

sky::SkyView AirOverFog::skyFrom(const glm::dvec3& eye, const scene::Sun& sun) const {
    const double floor = top_ - atmosphere_.groundHeight();
    if (!(sun == lights_.direct)) return sky::makeSkyViewAbove(atmosphere_, eye, sun, floor);
    const double height = atmosphere_.groundHeight() + atmosphere_.heightAt(eye);
    return sky::makeSkyViewAbove(atmosphere_, eye, sun, floor,
                                 [&](double up, double azimuth) { return changeOfSky(height, up, azimuth); });
}

/// Albedo of a ground below the air alone that sends as much light up at the top as the fog with its ground does.
glm::dvec3 AirOverFog::albedoAbove() const {
    const std::vector<FogLayer> air = layers();
    std::vector<FogLayer> all = fog_;
    all.insert(all.end(), air.begin(), air.end());
    FogSetting light = setting();
    const glm::dvec3 wanted = irradianceAbove(all, light);
    // light above ground of the albedo A rises as dark + gain A / (1 − back A)
    std::array<glm::dvec3, 3> rising;
    for (int i = 0; i < 3; ++i) {
        light.groundAlbedo = glm::dvec3(0.5 * i);
        rising[static_cast<std::size_t>(i)] = irradianceAbove(air, light);
    }
    const glm::dvec3 half = glm::max(rising[1] - rising[0], glm::dvec3(1e-30)), whole = rising[2] - rising[0];
    const glm::dvec3 ratio = whole / half, back = (ratio - 2.0) / (ratio - 1.0);
    const glm::dvec3 gain = whole * (1.0 - back), share = (wanted - rising[0]) / glm::max(gain, glm::dvec3(1e-30));
    return glm::clamp(share / (1.0 + back * share), glm::dvec3(0.0), glm::dvec3(1.0));
}

bool AirOverFog::isOf(const AirLights& lights, const std::vector<FogLayer>& fog, double highest) const {
    return lights_ == lights && fog_ == fog && highest_ == highest;
}

glm::dvec3 AirOverFog::sunAt(double height) const {
    return atmosphere_.sunColour(atmosphere_.aboveFoot(std::max(0.0, height - atmosphere_.groundHeight())),
                                 lights_.direct.directionTo);
}

std::vector<FogLayer> AirOverFog::layers() const {
    return layersUpTo(top_);
}

std::vector<FogLayer> AirOverFog::layersUpTo(double height) const {
    const sky::Air& air = atmosphere_.air();
    const double ground = atmosphere_.groundHeight();
    sky::Spectrum light = atmosphere_.sunTransmittance(top_ - ground, lights_.direct.directionTo.y);
    if (!(glm::compMin(air.rgb(light)) > 0.0)) light = sky::Spectrum(1.0);
    const auto colour = [&](const sky::Spectrum& coefficients) {
        return air.rgb(coefficients * light) / air.rgb(light);
    };
    const glm::dvec3 molecules = colour(air.molecules);
    FogLayer aerosol = airLayer(Scatterer::aerosol, colour(air.aerosolScattering), colour(air.aerosolExtinction),
                                aerosolHeight, ground, height);
    aerosol.g = air.asymmetry;
    std::vector<FogLayer> layers{airLayer(Scatterer::molecules, molecules, molecules, moleculeHeight, ground, height),
                                 aerosol};
    const glm::dvec3 factor =
        ofSlantPath(layers, sunAt(top_), sunAt(ground), ground, top_, lights_.direct.directionTo.y);
    for (FogLayer& layer : layers) {
        layer.scattering *= factor;
        layer.absorption *= factor;
    }
    return layers;
}

FogSetting AirOverFog::setting() const {
    FogSetting setting;
    setting.toSun = lights_.direct.directionTo;
    setting.sun = lights_.direct.irradiance * sunAt(top_);
    setting.groundHeight = atmosphere_.groundHeight();
    setting.groundAlbedo = albedo_;
    // a second light need not be the same to both sides of the first
    setting.skyAt = [this, axes = axesOf(lights_.direct.directionTo)](double up, double azimuth) {
        const double level = std::sqrt(std::max(0.0, 1.0 - up * up));
        const auto towards = [&](double side) {
            return axes * glm::dvec3(level * std::cos(azimuth), up, side * level * std::sin(azimuth));
        };
        return 0.5 * (above(top_, towards(1.0)).radiance + above(top_, towards(-1.0)).radiance);
    };
    return setting;
}

AirOverFog::Seen AirOverFog::seenFrom(const Eye& eye, const glm::dvec3& direction) const {
    Seen seen;
    for (const sky::SkyView& view : eye.views) seen.radiance += sky::radianceOf(view, direction);
    const sky::SkyView& first = eye.views.front();
    if (shared::aboveHorizon(first.params, glm::vec3(direction)) < 0.0F)
        seen.transmittance = sky::transmittanceOf(first, direction);
    return seen;
}

AirOverFog::Seen AirOverFog::above(double height, const glm::dvec3& direction) const {
    const auto next = std::ranges::find_if(eyes_, [&](const Eye& eye) { return eye.height >= height; });
    if (next == eyes_.begin()) return seenFrom(eyes_.front(), direction);
    if (next == eyes_.end()) return seenFrom(eyes_.back(), direction);
    const Eye &upper = *next, &lower = *(next - 1);
    const double share = (height - lower.height) / (upper.height - lower.height);
    const Seen below = seenFrom(lower, direction), over = seenFrom(upper, direction);
    return {glm::mix(below.radiance, over.radiance, share), glm::mix(below.transmittance, over.transmittance, share)};
}

glm::dvec3 FogSurroundings::sunShare(double height) const {
    if (air == nullptr) return fog.sunTransmittance(height);
    return height >= air->top() ? air->sunAt(height) : air->sunAt(air->top()) * fog.sunTransmittance(height);
}

glm::dvec3 FogSurroundings::radiance(double height, const glm::dvec3& direction) const {
    if (air == nullptr || height <= air->top()) return fog.radiance(height, direction);
    const AirOverFog::Seen seen = air->above(height, direction);
    if (seen.transmittance == glm::dvec3(0.0)) return seen.radiance;
    return seen.radiance + seen.transmittance * fog.radiance(air->top(), direction);
}

}  // namespace lumulus::fog_light
