#include "scene/finish_sky.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "scene/sunlight.h"

namespace lumulus::scene {

namespace {

/// Air of a preset: `sky.preset` has their names in this order.
struct Preset {
    bool hillaire;
    double aerosolDepth, angstrom, ozone;
};
constexpr std::array<Preset, 4> presets{
    {{false, 0.04, 1.14, 300.0}, {false, 0.084, 1.14, 300.0}, {false, 0.3, 1.14, 300.0}, {true, 0.084, 1.14, 300.0}}};

/// Refuses a key that the model does not read, unless --set has replaced the file's model.
void checkRead(const Settings& settings, const char* path, bool read, const char* mend) {
    const Setting* model = settings.find("sky.model");
    const Setting* given = settings.find(path);
    if (given == nullptr || read || (given->fromFile && model != nullptr && !model->fromFile)) return;
    throw InputError(fmt::format("{} has no effect", path), given->where, mend);
}

}  // namespace

void finishSky(Draft& draft, const Settings& settings) {
    Sky& sky = draft.scene.sky;
    const bool named = settings.find("sky.model") != nullptr || settings.find("sky.radiance") != nullptr;
    const bool alone = draft.scene.clouds.empty() && draft.scene.fields.empty() && !draft.scene.fog.media.empty() &&
                       draft.scene.lamps.empty();
    if (!named && !alone) {  // fog alone is that of `lumulus composite`, whose pictures have their light
        sky.model = SkyModel::atmosphere;
        sky.groundBelowClouds = !draft.scene.ground;
    }
    const bool air = sky.model == SkyModel::atmosphere;
    checkRead(settings, "sky.radiance", sky.model == SkyModel::constant,
              "leave it out, or write sky.model = \"constant\"");
    for (const char* key : {"sky.preset", "sky.aerosol_depth", "sky.angstrom", "sky.ozone", "sky.ground_albedo"})
        checkRead(settings, key, air, "leave it out, or write sky.model = \"atmosphere\"");
    if (draft.skyPreset) {
        const Preset& preset = presets.at(*draft.skyPreset);
        sky.hillaire = preset.hillaire;
        if (settings.find("sky.aerosol_depth") == nullptr) sky.aerosolDepth = preset.aerosolDepth;
        if (settings.find("sky.angstrom") == nullptr) sky.angstrom = preset.angstrom;
        if (settings.find("sky.ozone") == nullptr) sky.ozone = preset.ozone;
    }
    for (const char* key : {"sky.aerosol_depth", "sky.angstrom", "sky.ozone"})
        checkRead(settings, key, !sky.hillaire, "leave it out, or choose another sky.preset");
    if (!air) return;
    if (settings.find("sun.irradiance") == nullptr) draft.scene.sun.irradiance = sunAboveAir;
    if (settings.find("sun.limb_darkening") == nullptr) draft.scene.sun.limbDarkening = true;
    // radiances of a real sky are a hundred times what a file without exposure shows, by night a millionth
    if (settings.find("image.exposure_mode") == nullptr && settings.find("image.exposure") == nullptr)
        draft.scene.image.exposureMode = ExposureMode::automatic;
}

}  // namespace lumulus::scene
