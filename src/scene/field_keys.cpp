#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

constexpr std::array fieldKinds{FieldKind::cumulus, FieldKind::stratocumulus, FieldKind::cirrus};
constexpr Range diameters{1.0, 1e6};

Field& fieldOf(Draft& d) {
    return d.scene.fields.at(d.entry);
}

std::vector<Key> shapeKeys() {
    return {
        choice("field.kind", {"cumulus", "stratocumulus", "cirrus"}, "\"cumulus\"",
               "What the field is made of: scattered clouds, a deck of cells, or fibres of ice.",
               [](Draft& d, const Value& v) { fieldOf(d).kind = fieldKinds.at(v.choice); }),
        other("field.name", Type::text, "(\"field0\", \"field1\", …)",
              "For messages: the clouds of the field are called NAME[0], NAME[1] and so on. Letters, digits, `-` and "
              "`_`, a letter first; at most 64 of them.",
              [](Draft& d, const Value& v) { fieldOf(d).name = v.text; }),
        number("field.cover", unit, "0.3", "Share of the area that clouds cover, seen from above.",
               [](Draft& d, const Value& v) { fieldOf(d).cover = v.number; }),
        number("field.base", {-1e5, 1e5}, "1000.0", "Height in metres of the common base of all clouds.",
               [](Draft& d, const Value& v) { fieldOf(d).base = v.number; }),
        other("field.center", Type::vector, "[0.0, 0.0, 0.0]",
              "Middle of the area in metres. The second number is not used.",
              [](Draft& d, const Value& v) { fieldOf(d).center = v.vector; }),
        other("field.area", Type::vector, "[10000.0, 0.0, 10000.0]",
              "Extent of the area along x and z in metres. The second number is not used.",
              [](Draft& d, const Value& v) { fieldOf(d).area = v.vector; }),
        number("field.smallest", diameters, "200.0", "Smallest diameter of a cloud in metres.",
               [](Draft& d, const Value& v) { fieldOf(d).smallest = v.number; }),
        number("field.largest", diameters, "2000.0",
               "Largest diameter of a cloud in metres. Cells of a deck have the mean of smallest and largest.",
               [](Draft& d, const Value& v) { fieldOf(d).largest = v.number; }),
        number(
            "field.exponent", {0.0, 10.0}, "1.7",
            "The number of clouds falls with this power of the diameter (Neggers et al. 2003: 1.7 below a kilometre; "
            "Benner and Curry 1998: 2.0 below and 3.1 above). Not for `stratocumulus`.",
            [](Draft& d, const Value& v) { fieldOf(d).exponent = v.number; }),
    };
}

std::vector<Key> cloudsOfFieldKeys() {
    return {
        integer("field.variants", {1.0, 64.0}, "6",
                "Number of different clouds. Each is shown many times, rotated and scaled.",
                [](Draft& d, const Value& v) { fieldOf(d).variants = static_cast<int>(v.integer); }),
        integer("field.resolution", {8.0, 1024.0}, "128", "Voxels along the longest side of each variant.",
                [](Draft& d, const Value& v) { fieldOf(d).resolution = static_cast<int>(v.integer); }),
        integer("field.seed", seeds, "1", "Seed of shapes and places.",
                [](Draft& d, const Value& v) { fieldOf(d).seed = static_cast<std::uint64_t>(v.integer); }),
        other(
            "field.wind", Type::wind, "[0.0, 0.0, 0.0]",
            "Wind in m/s, or rows of a height in metres and the wind there, lowest first: linear between them, "
            "constant "
            "beyond. It carries each cloud by the middle of its height. Fibres of cirrus and rows of clouds lie along "
            "that at `base`; without wind fibres lie along x.",
            [](Draft& d, const Value& v) { fieldOf(d).wind = v.wind; }),
        number("field.extinction", coefficients, "0.08", "Extinction at density 1, 1/m.",
               [](Draft& d, const Value& v) { fieldOf(d).extinction = v.number; }),
        rgb("field.albedo", unit, "1.0", "Single-scattering albedo of the clouds.",
            [](Draft& d, const Value& v) { fieldOf(d).albedo = v.vector; }),
    };
}

}  // namespace

std::vector<Key> fieldKeys() {
    std::vector<Key> keys = shapeKeys();
    for (Key& key : cloudsOfFieldKeys()) keys.push_back(std::move(key));
    return keys;
}

}  // namespace lumulus::scene
