#include "scene/key_rows.h"

namespace lumulus::scene {

std::vector<Key> mapKeys() {
    return {
        other(
            "sky.map", Type::path, "(none)",
            "For `map`: name of an EXR file, a latitude-longitude picture of the surroundings, twice as wide as high. "
            "The zenith is at its upper edge, -Z in the middle of its width and +X a quarter of the width to the "
            "right of that (as `camera.projection = \"panorama\"` draws it towards -Z).",
            [](Draft& d, const Value& v) { d.scene.sky.map = (d.folder / v.text).lexically_normal(); }),
        number("sky.map_scale", {0.0, 1e9, true}, "1.0", "For `map`: factor for its values, which then are W/(m² sr).",
               [](Draft& d, const Value& v) { d.scene.sky.mapScale = v.number; }),
        number("sky.map_rotation", {-360.0, 360.0}, "0.0",
               "For `map`: degrees by which it is rotated clockwise, seen from above.",
               [](Draft& d, const Value& v) { d.scene.sky.mapRotation = v.number; }),
        other(
            "sky.map_sun", Type::boolean, "true",
            "For `map`: whether a compact bright spot of it becomes the sun: 50 times as bright as the ring from 5° to "
            "10° around it. The keys of `sun` then have no effect. Without such a spot, and with `false`, the sun "
            "shines only where `sun.irradiance` is given.",
            [](Draft& d, const Value& v) { d.scene.sky.mapSun = v.boolean; }),
    };
}

}  // namespace lumulus::scene
