#include "bake/light_file.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>

#include "base/atomic_file.h"
#include "base/version.h"
#include "render/ambient.h"

namespace lumulus::bake {
namespace {

using json = nlohmann::ordered_json;

constexpr const char* irradiance = "W m^-2";
constexpr const char* harmonic = "W m^-2 sr^-1/2";
constexpr std::array channels{"red", "green", "blue"};

std::string phaseName(const scene::Phase& phase) {
    using enum scene::PhaseModel;
    switch (phase.model) {
        case henyeyGreenstein:
            return "hg";
        case schlick:
            return "schlick";
        case rayleigh:
            return "rayleigh";
        case hazy:
            return "hazy";
        case murky:
            return "murky";
        case droplet:
            return "droplet";
        case mie:
            return "mie";
        case table:
            return "table";
    }
    return "";
}

json vectorOf(const glm::dvec3& v) {
    return json::array({v.x, v.y, v.z});
}

/// A grid of a value of each voxel.
template <typename Value>
vdb::VectorGrid made(std::string name, const char* unit, std::string meaning, const LightGrid& grid,
                     const Value& value) {
    vdb::VectorGrid result{std::move(name), unit, std::move(meaning), false, {}};
    result.values.reserve(grid.light.size());
    for (const VoxelLight& light : grid.light) result.values.push_back(value(light));
    return result;
}

json gridsJson(const LightGrid& grid) {
    json all = json::object();
    LightGrid empty = grid;
    empty.places.clear();
    empty.light.clear();
    for (const vdb::VectorGrid& one : gridsOf(empty).grids)
        all[one.name] = {{"type", "vec3s"},
                         {"components", one.isDirection ? "x, y, z" : "red, green, blue"},
                         {"unit", one.unit},
                         {"meaning", one.meaning}};
    return all;
}

json cloudsJson(const scene::Scene& scene) {
    json clouds = json::array();
    for (std::size_t i = 0; i < scene.clouds.size(); ++i) {
        const scene::Cloud& cloud = scene.clouds[i];
        clouds.push_back({{"name", scene::nameOf(scene, i)},
                          {"extinction", cloud.extinction * cloud.densityScale},
                          {"extinction_unit", "m^-1 at density 1"},
                          {"albedo", vectorOf(cloud.albedo)},
                          {"phase", {{"model", phaseName(cloud.phase)}, {"g", cloud.phase.g}}}});
    }
    return clouds;
}

}  // namespace

LightPlaces placesOf(const std::filesystem::path& vdb, bool nano) {
    LightPlaces places{vdb, vdb, {}};
    places.conventions.replace_extension(".json");
    if (nano) {
        places.nano = vdb;
        places.nano.replace_extension(".nvdb");
    }
    return places;
}

vdb::VectorGrids gridsOf(const LightGrid& grid) {
    vdb::VectorGrids all{grid.voxel, grid.places, {}};
    const glm::vec3 toSun(grid.toSun);
    all.grids.push_back(made("fluence", irradiance, "integral of radiance over all directions, with the sun", grid,
                             [](const VoxelLight& light) { return light.fluence(); }));
    for (int channel = 0; channel < 3; ++channel) {
        const std::string name = channels[static_cast<std::size_t>(channel)];
        all.grids.push_back(made("flux_" + name, irradiance,
                                 "net flux of " + name + " light, with the sun, pointing to where the light goes", grid,
                                 [&](const VoxelLight& light) { return light.flux(channel, toSun); }));
        all.grids.back().isDirection = true;
    }
    all.grids.push_back(made("sun", irradiance, "irradiance by the sun, through the clouds, of a plane that faces it",
                             grid, [](const VoxelLight& light) { return light.sun; }));
    for (std::size_t i = 0; i < 9; ++i)
        all.grids.push_back(made("sh" + std::to_string(i), harmonic,
                                 fmt::format("coefficient {} of radiance, without what comes straight from the sun", i),
                                 grid, [i](const VoxelLight& light) { return light.coefficients[i]; }));
    return all;
}

std::string conventionsOf(const LightGrid& grid, const scene::Scene& scene, const std::filesystem::path& vdb) {
    json file;
    file["format"] = "lumulus light";
    file["version"] = 1;
    file["software"] = std::string("lumulus ") + version;
    file["scene"] = scene.source;
    file["seed"] = scene.photonMap.seed;
    file["file"] = vdb.filename().string();
    file["frame"] = {{"length_unit", "metre"},
                     {"axes", "right-handed: +x east, +y up, -z north"},
                     {"voxel_size", grid.voxel},
                     {"voxels", grid.places.size()},
                     {"place", "index (i, j, k) is the middle of a voxel, at voxel_size * (i, j, k)"},
                     {"active", "voxels with density, and those that touch one"},
                     {"mean", "of light over the extinction in a voxel"}};
    file["colour"] = "linear, primaries of Rec. 709";
    file["grids"] = gridsJson(grid);
    file["harmonics"] = {
        {"radiance", "L(w) = sum over i of sh_i y_i(w), real, orthonormal, l = 0, 1, 1, 1, 2, 2, 2, 2, 2"},
        {"direction", "w = (x, y, z) points to where the light comes from"},
        {"basis", ambientFormulas},
        {"scattered",
         "into direction v: extinction * albedo * (sum over i of g_l sh_i y_i(-v) + sun * p(cos)), with g_l the l-th "
         "Legendre moment of the phase function p (g^l of Henyey-Greenstein), cos the cosine between v and "
         "-direction_to_sun"}};
    file["direction_to_sun"] = vectorOf(grid.toSun);
    file["clouds"] = cloudsJson(scene);
    return file.dump(2) + "\n";
}

void writeLight(const LightPlaces& places, const LightGrid& grid, const scene::Scene& scene, const Report& report,
                const Check& check) {
    report("writing", 0, 1);
    const vdb::VectorGrids grids = gridsOf(grid);
    const std::string conventions = conventionsOf(grid, scene, places.vdb);
    if (!places.nano.empty()) vdb::writeVectors(places.nano, grids, vdb::VectorFormat::nanoVdb, check);
    vdb::writeVectors(places.vdb, grids, vdb::VectorFormat::openVdb, check);
    writeFile(places.conventions, std::as_bytes(std::span(conventions)));
    report("writing", 1, 1);
}

}  // namespace lumulus::bake
