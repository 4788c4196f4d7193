#include "environment/conventions.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/version.h"
#include "prefilter/layouts.h"
#include "sky/atmosphere.h"

namespace lumulus::environment {
namespace {

using json = nlohmann::ordered_json;

constexpr const char* radianceUnit = "W m^-2 sr^-1";
constexpr const char* axes = "right-handed: +x east, +y up, -z north";
constexpr const char* luminance = "683 lm/W * (0.2126 R + 0.7152 G + 0.0722 B)";

json vectorOf(const glm::dvec3& v) {
    return json::array({v.x, v.y, v.z});
}

std::string textOf(const glm::dvec3& v) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z);
}

/// Factor from a coefficient of radiance to that of irradiance (Ramamoorthi and Hanrahan 2001).
double irradianceFactor(std::size_t i) {
    using std::numbers::pi;
    return i == 0 ? pi : (i < 4 ? 2.0 * pi / 3.0 : pi / 4.0);
}

std::string methodText(Method method) {
    if (method == Method::thesis)
        return "means over cones as wide as lobes of Beckmann's distribution (Moschos 2017), weights add up to 1";
    return "GGX with alpha = roughness^2, seen along the normal; filtered importance sampling";
}

json levelsJson(const FileOptions& options) {
    const std::vector<std::filesystem::path> names = namesOf(options);
    const std::size_t count = options.levels.size(), firstFace = 4 + (options.byLevel ? count : 0);
    json levels = json::array();
    for (std::size_t i = 0; i < count; ++i) {
        json level{{"level", i}, {"roughness", options.levels[i].roughness}, {"size", options.levels[i].size}};
        if (options.byLevel) level["latlong"] = names[4 + i].filename().string();
        for (std::size_t face = 0; options.byFace && face < 6; ++face)
            level["faces"][prefilter::faceNames[face]] = names[firstFace + face * count + i].filename().string();
        levels.push_back(level);
    }
    return levels;
}

json layoutsJson(const FileOptions& options) {
    const std::vector<std::filesystem::path> names = namesOf(options);
    json layouts{{"cube",
                  {{"file", names[0].filename().string()},
                   {"layout",
                    "envmap = cube of OpenEXR: faces +X -X +Y -Y +Z -Z one below the other, outer pixels on the edges"},
                   {"mip_levels", "level i has the roughness of levels[i]; further levels only fill the file"}}},
                 {"latlong",
                  {{"file", names[2].filename().string()},
                   {"layout",
                    "latitude-longitude, +y at the upper edge, +x in the middle, +z a quarter of the width to the "
                    "right, pixels are areas"}}}};
    if (options.byFace)
        layouts["faces"] =
            "texture coordinates of OpenGL, Vulkan and Direct3D, pixels are areas, rows from the top: a "
            "cube sampled in direction d has the light from d";
    return layouts;
}

json lightsJson(const Surroundings& surroundings) {
    json lights = json::array();
    for (const Luminary& light : surroundings.lights)
        lights.push_back({{"name", light.name},
                          {"direction_to", vectorOf(light.directionTo)},
                          {"angular_radius", light.angularRadius},
                          {"irradiance", vectorOf(light.irradiance())},
                          {"illuminance", sky::photometric(light.irradiance())},
                          {"transmittance", vectorOf(light.transmittance)},
                          {"irradiance_in_air", vectorOf(light.irradianceInAir)}});
    return lights;
}

json harmonicsJson(const AmbientLight& light) {
    json radiance = json::array(), irradiance = json::array();
    for (std::size_t i = 0; i < light.coefficients.size(); ++i) {
        radiance.push_back(vectorOf(light.coefficients[i]));
        irradiance.push_back(vectorOf(irradianceFactor(i) * light.coefficients[i]));
    }
    return {{"radiance", radiance},
            {"irradiance", irradiance},
            {"meaning",
             "L(w) = sum of radiance_i y_i(w), W m^-2 sr^-1; E(n) = sum of irradiance_i y_i(n), W m^-2, on a "
             "plane with normal n; real, orthonormal"},
            {"basis", ambientFormulas}};
}

std::map<std::string, std::string> attributesOf(const Surroundings& surroundings, const scene::Scene& scene,
                                                const FileOptions& options) {
    std::map<std::string, std::string> all{{"software", std::string("lumulus ") + version},
                                           {"scene", scene.source},
                                           {"environment.point", textOf(surroundings.point)},
                                           {"environment.axes", axes},
                                           {"environment.unit", radianceUnit},
                                           {"environment.luminance", luminance},
                                           {"environment.method", methodText(options.method)}};
    std::string& roughness = all["environment.roughness"];
    for (const Level& level : options.levels)
        roughness += fmt::format("{}{:g}", roughness.empty() ? "" : " ", level.roughness);
    std::string& harmonics = all["environment.irradiance_sh"];
    for (std::size_t i = 0; i < 9; ++i)
        harmonics += (i == 0 ? "" : ", ") + textOf(irradianceFactor(i) * surroundings.harmonics.coefficients[i]);
    for (const Luminary& light : surroundings.lights) {
        all["environment." + light.name + ".direction_to"] = textOf(light.directionTo);
        all["environment." + light.name + ".irradiance"] = textOf(light.irradiance());
        all["environment." + light.name + ".angular_radius"] = fmt::format("{:.9g}", light.angularRadius);
    }
    all["environment.discs"] = surroundings.discsInMap ? "in the map" : "not in the map";
    return all;
}

}  // namespace

std::string brdfText(Method method) {
    const std::string by = method == Method::thesis ? "Cook-Torrance with Beckmann's distribution, alpha = roughness"
                                                    : "GGX, height-correlated Smith, alpha = roughness^2";
    return by +
           "; n.v at (x + 0.5) / width, roughness at (y + 0.5) / height from the top; reflected = F0 * R + G; R + G is "
           "the energy E of Turquin (2019): times 1 + F0 * (1 / E - 1) with light between microfacets";
}

Conventions conventionsOf(const Surroundings& surroundings, const scene::Scene& scene, const FileOptions& options) {
    json file;
    file["format"] = "lumulus environment";
    file["version"] = 1;
    file["software"] = std::string("lumulus ") + version;
    file["scene"] = scene.source;
    file["seed"] = scene.photonMap.seed;
    file["point"] = vectorOf(surroundings.point);
    file["axes"] = axes;
    file["colour"] = "linear, primaries of Rec. 709";
    file["units"] = {{"radiance", radianceUnit},    {"irradiance", "W m^-2 on a plane that faces the light"},
                     {"illuminance", "lx"},         {"luminance", luminance},
                     {"angular_radius", "degrees"}, {"point", "metres"}};
    file["method"] = methodText(options.method);
    file["levels"] = levelsJson(options);
    file["layouts"] = layoutsJson(options);
    file["lights"] = lightsJson(surroundings);
    file["discs_in_map"] = surroundings.discsInMap;
    file["harmonics"] = harmonicsJson(surroundings.harmonics);
    file["brdf"] = {{"file", namesOf(options)[3].filename().string()}, {"meaning", brdfText(options.method)}};
    return {file.dump(2) + "\n", attributesOf(surroundings, scene, options)};
}

}  // namespace lumulus::environment
