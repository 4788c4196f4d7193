#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {

namespace {

constexpr std::array skyModels{SkyModel::constant, SkyModel::atmosphere, SkyModel::map};

}  // namespace

std::vector<Key> atmosphereKeys() {
    return {
        choice("sky.model", {"constant", "atmosphere", "map"}, "(`\"atmosphere\"` or `\"constant\"`)",
               "`atmosphere` is the air around a planet, lit by the sun: sky, ground, sunlight and air before the "
               "clouds all "
               "follow from it (docs/atmosphere.md). `constant` has the same radiance in all directions; it is the "
               "default of a scene that gives `sky.radiance`, or has fog and no clouds. `map` is a picture of the "
               "surroundings.",
               [](Draft& d, const Value& v) { d.scene.sky.model = skyModels.at(v.choice); }),
        choice("sky.preset", {"clear", "continental", "hazy", "hillaire"}, "\"continental\"",
               "For `atmosphere`: the air, which the keys below may change. `clear` has an aerosol depth of 0.04, "
               "`continental` 0.084 (ASTM G173), `hazy` 0.3; `hillaire` is the medium of Hillaire (2020) at three "
               "wavelengths.",
               [](Draft& d, const Value& v) { d.skyPreset = v.choice; }),
        number("sky.aerosol_depth", {0.0, 10.0}, "(of the preset)",
               "For `atmosphere`: vertical optical depth of the aerosol at 500 nm.",
               [](Draft& d, const Value& v) { d.scene.sky.aerosolDepth = v.number; }),
        number("sky.angstrom", {-1.0, 4.0}, "(of the preset: 1.14)",
               "For `atmosphere`: Ångström's exponent, by which the aerosol's depth falls with the wavelength.",
               [](Draft& d, const Value& v) { d.scene.sky.angstrom = v.number; }),
        number("sky.ozone", {0.0, 1000.0}, "(of the preset: 300.0)",
               "For `atmosphere`: column of ozone in Dobson units.",
               [](Draft& d, const Value& v) { d.scene.sky.ozone = v.number; }),
        rgb("sky.ground_albedo", unit, "0.2",
            "For `atmosphere`: share of the light that the planet's ground reflects (Lambert).",
            [](Draft& d, const Value& v) { d.scene.sky.groundAlbedo = v.vector; }),
    };
}

}  // namespace lumulus::scene
