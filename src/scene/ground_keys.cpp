#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

/// A scene has a ground once it has a key of it.
Ground& groundOf(Draft& d) {
    if (!d.scene.ground) d.scene.ground.emplace();
    return *d.scene.ground;
}

}  // namespace

std::vector<Key> groundKeys() {
    return {
        rgb("ground.albedo", unit, "0.2",
            "Share of the light that the ground reflects, equally in all directions (Lambert). Without any key of this "
            "section nothing is below the clouds (below an atmosphere: the planet, at y = 0).",
            [](Draft& d, const Value& v) { groundOf(d).albedo = v.vector; }),
        number("ground.height", {-1e6, 1e6}, "0.0",
               "Height of the ground: y in metres. It is a plane, or a sphere of 6360 km below an atmosphere.",
               [](Draft& d, const Value& v) { groundOf(d).height = v.number; }),
    };
}

}  // namespace lumulus::scene
