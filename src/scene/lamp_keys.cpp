#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

constexpr std::array lampKinds{LampKind::point, LampKind::spot, LampKind::pyramid};

Lamp& lampOf(Draft& d) {
    return d.scene.lamps.at(d.entry);
}

}  // namespace

std::vector<Key> lampKeys() {
    return {
        choice("lamp.kind", {"point", "spot", "pyramid"}, "\"point\"",
               "Where it shines: everywhere; in a cone; in a pyramid of square section, two sides of which are level "
               "(docs/lamps.md).",
               [](Draft& d, const Value& v) { lampOf(d).kind = lampKinds.at(v.choice); }),
        other("lamp.name", Type::text, "(its index)", "Name of the lamp, for `--set lamp.NAME.power=100`.",
              [](Draft& d, const Value& v) { lampOf(d).name = v.text; }),
        other("lamp.position", Type::vector, "[0.0, 0.0, 0.0]", "Its middle, in metres.",
              [](Draft& d, const Value& v) { lampOf(d).position = v.vector; }),
        other("lamp.direction", Type::vector, "(`target` instead)",
              "For `spot` and `pyramid`: direction of the axis, away from the lamp, of any length.",
              [](Draft& d, const Value& v) { lampOf(d).direction = v.vector; }),
        other("lamp.target", Type::vector, "(`direction` instead)",
              "For `spot` and `pyramid`: a point on the axis, in metres.",
              [](Draft& d, const Value& v) { d.lampTargets[d.entry] = v.vector; }),
        number("lamp.angle", {0.0, 180.0, true}, "60.0",
               "For `spot` and `pyramid`: angle in degrees between opposite sides. At 180 it lights the half of all "
               "directions that lies before it.",
               [](Draft& d, const Value& v) { lampOf(d).angle = v.number; }),
        number("lamp.softness", unit, "0.0",
               "For `spot` and `pyramid`: share of the half angle over which the light fades towards the sides.",
               [](Draft& d, const Value& v) { lampOf(d).softness = v.number; }),
        number("lamp.radius", {0.0, 1e6, true}, "0.1", "Radius in metres of the sphere that shines.",
               [](Draft& d, const Value& v) { lampOf(d).radius = v.number; }),
        rgb("lamp.power", light, "(`lumens` instead)",
            "Radiant flux over all directions that it lights, W per channel. A narrower cone of the same power is "
            "brighter.",
            [](Draft& d, const Value& v) { lampOf(d).power = v.vector; }),
        number("lamp.lumens", {0.0, 1e9}, "(`power` instead)", "Luminous flux in lm, of 683 lm/W.",
               [](Draft& d, const Value& v) { d.lampLumens[d.entry] = v.number; }),
        number("lamp.temperature", {1000.0, 40000.0}, "(white)",
               "With `lumens`: colour as that of a black body of this temperature in K.",
               [](Draft& d, const Value& v) { d.lampTemperatures[d.entry] = v.number; }),
        other("lamp.on", Type::boolean, "true", "Whether it shines.",
              [](Draft& d, const Value& v) { lampOf(d).on = v.boolean; }),
    };
}

}  // namespace lumulus::scene
