#include "scene/key_rows.h"

namespace lumulus::scene {

std::vector<Key> sunAndSkyKeys() {
    return {
        other("sun.direction_to", Type::vector, "(from azimuth and elevation)",
              "Direction towards the sun, of any length, instead of azimuth and elevation.",
              [](Draft& d, const Value& v) { d.directionTo = v.vector; }),
        number("sun.azimuth", {-360.0, 360.0}, "70.0",
               "Azimuth of the sun in degrees, clockwise seen from above: 0 is towards -Z, 90 towards +X.",
               [](Draft& d, const Value& v) { d.azimuth = v.number; }),
        number("sun.elevation", {-90.0, 90.0}, "35.0", "Elevation of the sun in degrees above the horizon.",
               [](Draft& d, const Value& v) { d.elevation = v.number; }),
        rgb("sun.irradiance", light, "[210.45, 189.23, 185.23]",
            "Irradiance on a plane that faces the sun, W/m² per channel: above the air where `sky.model` is "
            "`atmosphere`. Of a constant sky and a map the default is [5.0, 4.8, 4.4]. 0 means no sun.",
            [](Draft& d, const Value& v) { d.scene.sun.irradiance = v.vector; }),
        number("sun.angular_diameter", {0.0, 90.0}, "0.53", "Angular diameter of the sun in degrees.",
               [](Draft& d, const Value& v) { d.scene.sun.angularDiameter = v.number; }),
        rgb("sky.radiance", light, "(of a constant sky: [0.12, 0.22, 0.42])",
            "For `constant`: radiance of the sky, W/(m² sr) per channel.",
            [](Draft& d, const Value& v) { d.scene.sky.radiance = v.vector; }),
    };
}

}  // namespace lumulus::scene
