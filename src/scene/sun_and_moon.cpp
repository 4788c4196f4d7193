#include "scene/sun_and_moon.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "base/error.h"
#include "scene/ephemeris.h"

namespace lumulus::scene {
namespace {

std::string whereOf(const Settings& settings, const char* path) {
    const Setting* setting = settings.find(path);
    return setting == nullptr ? path : setting->where;
}

/// All three keys of [time], or none.
void requireWhole(const Settings& settings) {
    constexpr std::array keys{"time.utc", "time.latitude", "time.longitude"};
    for (const char* missing : keys) {
        if (settings.find(missing) != nullptr) continue;
        for (const char* given : keys)
            if (settings.find(given) != nullptr)
                throw InputError(fmt::format("{} is given without {}", given, missing), whereOf(settings, given),
                                 "give utc, latitude and longitude together");
    }
}

Utc utcOf(const Time& time, const Settings& settings) {
    const Utc utc = parseUtc(time.utc).value();  // it was checked when it was read
    if (utc.year < firstYear || utc.year > lastYear)
        throw InputError(fmt::format("the year {} is not from {} to {}", utc.year, firstYear, lastYear),
                         whereOf(settings, "time.utc"),
                         "give another year: sun and moon are known well enough within that time alone");
    return utc;
}

void finishTime(Draft& draft, const Settings& settings) {
    requireWhole(settings);
    const Time& time = *draft.scene.time;
    const SunAndMoon sky = sunAndMoonAt(utcOf(time, settings), {time.latitude, time.longitude});
    draft.scene.sun.directionTo = skyDirection(sky.sun.azimuth, sky.sun.elevation);
    draft.scene.moon.directionTo = skyDirection(sky.moon.azimuth, sky.moon.elevation);
    draft.scene.moon.phaseAngle = sky.moonPhaseAngle;
}

void finishSun(Draft& draft, const Settings& settings) {
    if (draft.directionTo) {
        const double length = glm::length(*draft.directionTo);
        if (!(length > 1e-12)) {
            throw InputError("direction_to must have a length", whereOf(settings, "sun.direction_to"),
                             "give a direction towards the sun, as [0, 1, 0]");
        }
        draft.scene.sun.directionTo = *draft.directionTo / length;
    } else if (draft.azimuth || draft.elevation) {
        draft.scene.sun.directionTo =
            skyDirection(draft.azimuth.value_or(defaultAzimuth), draft.elevation.value_or(defaultElevation));
    }
}

void finishMoon(Draft& draft) {
    constexpr double azimuth = 250.0, elevation = 30.0;  // as in Moon
    if (draft.moonAzimuth || draft.moonElevation)
        draft.scene.moon.directionTo =
            skyDirection(draft.moonAzimuth.value_or(azimuth), draft.moonElevation.value_or(elevation));
}

}  // namespace

void finishSunAndMoon(Draft& draft, const Settings& settings) {
    if (draft.scene.time) return finishTime(draft, settings);
    finishSun(draft, settings);
    finishMoon(draft);
}

void finishSunDistance(Draft& draft, const Settings& settings) {
    Scene& scene = draft.scene;
    if (!scene.time || scene.sky.model != SkyModel::atmosphere || settings.find("sun.irradiance") != nullptr) return;
    const double distance =
        sunAndMoonAt(utcOf(*scene.time, settings), {scene.time->latitude, scene.time->longitude}).sun.distance;
    scene.sun.irradiance /= distance * distance;
}

}  // namespace lumulus::scene
