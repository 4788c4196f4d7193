#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

Time& timeOf(Draft& d) {
    if (!d.scene.time) d.scene.time.emplace();
    return *d.scene.time;
}

}  // namespace

std::vector<Key> timeKeys() {
    return {
        other("time.utc", Type::time, "(none: sun and moon stand where `sun` and `moon` say)",
              "Universal time, with or without quotes, from 1950 to 2050. Sun and moon then stand where they stood, "
              "with north towards -Z and east towards +X.",
              [](Draft& d, const Value& v) { timeOf(d).utc = v.text; }),
        number("time.latitude", {-90.0, 90.0}, "(required with `utc`)", "Degrees, north positive.",
               [](Draft& d, const Value& v) { timeOf(d).latitude = v.number; }),
        number("time.longitude", {-180.0, 180.0}, "(required with `utc`)", "Degrees, east positive.",
               [](Draft& d, const Value& v) { timeOf(d).longitude = v.number; }),
        other("moon.shines", Type::boolean, "false",
              "Under an atmosphere: whether the moon lights the scene, as a second sun.",
              [](Draft& d, const Value& v) { d.scene.moon.shines = v.boolean; }),
        number("moon.azimuth", {-360.0, 360.0}, "250.0", "Azimuth of the moon in degrees, as that of the sun.",
               [](Draft& d, const Value& v) { d.moonAzimuth = v.number; }),
        number("moon.elevation", {-90.0, 90.0}, "30.0", "Elevation of the moon in degrees above the horizon.",
               [](Draft& d, const Value& v) { d.moonElevation = v.number; }),
        number("moon.phase_angle", {0.0, 180.0}, "0.0",
               "Angle sun-moon-earth in degrees, on which the moon's brightness depends: 0 is full, 90 half, 180 new.",
               [](Draft& d, const Value& v) { d.scene.moon.phaseAngle = v.number; }),
        // beside the other rows of the sun, which follow
        other("sun.refraction", Type::boolean, "false",
              "Whether the air lifts the sun's disc: by half a degree at the horizon. The light keeps its direction.",
              [](Draft& d, const Value& v) { d.scene.sun.refraction = v.boolean; }),
        other("sun.limb_darkening", Type::boolean, "(true under an atmosphere, else false)",
              "Whether the sun's disc is darker towards its rim.",
              [](Draft& d, const Value& v) { d.scene.sun.limbDarkening = v.boolean; }),
    };
}

}  // namespace lumulus::scene
