#include "cli/sky.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "scene/load.h"
#include "sky/sky_report.h"

namespace lumulus::cli {
namespace {

using Json = nlohmann::ordered_json;

Json listOf(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Json jsonOf(const sky::Luminary& luminary) {
    return {{"elevation", luminary.elevation},
            {"azimuth", luminary.azimuth},
            {"illuminance", luminary.illuminance},
            {"irradiance", listOf(luminary.irradiance)},
            {"chromaticity", {luminary.chromaticity.x, luminary.chromaticity.y}}};
}

Json jsonOf(const scene::Scene& scene, const glm::dvec3& place, const sky::SkyReport& report) {
    Json json;
    if (scene.time)
        json["time"] = {
            {"utc", scene.time->utc}, {"latitude", scene.time->latitude}, {"longitude", scene.time->longitude}};
    json["position"] = listOf(place);
    json["sun"] = jsonOf(report.sun);
    json["sun"]["refraction"] = report.refraction;
    json["sky"] = {{"illuminance", report.skyIlluminance},
                   {"zenith_luminance", report.zenithLuminance},
                   {"horizon_luminance", report.horizonLuminance}};
    json["moon"] = jsonOf(report.moon);
    json["moon"]["phase_angle"] = report.moonPhaseAngle;
    json["moon"]["shines"] = scene.moon.shines;
    return json;
}

std::string line(const std::string& name, const std::string& value) {
    return fmt::format("{:<22} {}\n", name, value);
}

std::string textOf(const std::string& name, const sky::Luminary& luminary) {
    const glm::dvec3& e = luminary.irradiance;
    return line(name + ".elevation", fmt::format("{:.3f}°", luminary.elevation)) +
           line(name + ".azimuth", fmt::format("{:.3f}°", luminary.azimuth)) +
           line(name + ".illuminance", fmt::format("{:.4g} lx", luminary.illuminance)) +
           line(name + ".irradiance", fmt::format("{:.4g} {:.4g} {:.4g} W/m²", e.r, e.g, e.b));
}

std::string textOf(const scene::Scene& scene, const glm::dvec3& place, const sky::SkyReport& report) {
    const char* shines = scene.moon.shines ? "" : " (it does not shine: moon.shines)";
    return line("at", fmt::format("{:g} {:g} {:g} m", place.x, place.y, place.z)) + textOf("sun", report.sun) +
           line("sun.refraction", fmt::format("{:.3f}°", report.refraction)) +
           line("sky.illuminance", fmt::format("{:.4g} lx", report.skyIlluminance)) +
           line("sky.zenith_luminance", fmt::format("{:.4g} cd/m²", report.zenithLuminance)) +
           line("sky.horizon_luminance", fmt::format("{:.4g} cd/m²", report.horizonLuminance)) +
           textOf("moon", report.moon) +
           line("moon.phase_angle", fmt::format("{:.3f}°{}", report.moonPhaseAngle, shines));
}

}  // namespace

void runSky(const SkyOptions& options) {
    const scene::Scene scene = options.scene ? scene::loadScene(*options.scene, options.overrides, std::nullopt,
                                                                static_cast<double>(options.frame.value_or(0)))
                                             : scene::parseScene("", "defaults", options.overrides);
    const glm::dvec3 place = sky::observerOf(scene);
    const sky::SkyReport report = sky::reportSky(scene, place);
    printOut(options.json ? jsonOf(scene, place, report).dump(2) + "\n" : textOf(scene, place, report));
}

}  // namespace lumulus::cli
