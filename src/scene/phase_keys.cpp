#include <array>

#include "scene/key_rows.h"

namespace lumulus::scene {
namespace {

constexpr std::array phaseModels{PhaseModel::henyeyGreenstein,
                                 PhaseModel::henyeyGreenstein,
                                 PhaseModel::schlick,
                                 PhaseModel::rayleigh,
                                 PhaseModel::hazy,
                                 PhaseModel::murky,
                                 PhaseModel::droplet,
                                 PhaseModel::mie,
                                 PhaseModel::table};

Phase& phaseOfCloud(Draft& d) {
    return d.scene.clouds.at(d.entry).phase;
}

Phase& phaseOfField(Draft& d) {
    return d.scene.fields.at(d.entry).phase;
}

/// The names of the keys of one table.
struct Names {
    Text model, g, dropletDiameter, effectiveRadius, effectiveVariance, table;
};

constexpr Names ofClouds{"cloud.phase.model",
                         "cloud.phase.g",
                         "cloud.phase.droplet_diameter",
                         "cloud.phase.effective_radius",
                         "cloud.phase.effective_variance",
                         "cloud.phase.table"};
constexpr Names ofFields{"field.phase.model",
                         "field.phase.g",
                         "field.phase.droplet_diameter",
                         "field.phase.effective_radius",
                         "field.phase.effective_variance",
                         "field.phase.table"};

template <Phase& (*phaseOf)(Draft&)>
std::vector<Key> keysOf(const Names& names) {
    return {
        choice(names.model,
               {"henyey-greenstein", "hg", "schlick", "rayleigh", "hazy", "murky", "droplet", "mie", "table"},
               "\"henyey-greenstein\"",
               "`hg` is short for `henyey-greenstein`; `schlick` approximates it; `hazy` and `murky` are Nishita's "
               "(1987); `droplet` is the fit of Jendersie and d'Eon (2023) for fog and clouds; `mie` is exact for "
               "droplets of water, with fogbow and glory (docs/droplets.md); `table` reads a file.",
               [](Draft& d, const Value& v) { phaseOf(d).model = phaseModels.at(v.choice); }),
        number(names.g, {-1.0, 1.0, true, true}, "0.85",
               "Mean cosine of scattering, for `henyey-greenstein` and `schlick`.",
               [](Draft& d, const Value& v) { phaseOf(d).g = v.number; }),
        number(names.dropletDiameter, {5.0, 50.0}, "20.0", "Diameter of droplets in micrometres, for `droplet`.",
               [](Draft& d, const Value& v) { phaseOf(d).dropletDiameter = v.number; }),
        number(names.effectiveRadius, {2.0, 50.0}, "10.0",
               "Effective radius of droplets in micrometres, for `mie`: the mean of r³ over the mean of r².",
               [](Draft& d, const Value& v) { phaseOf(d).effectiveRadius = v.number; }),
        number(names.effectiveVariance, {0.01, 0.5}, "0.1",
               "Effective variance of the gamma distribution of radii, for `mie`. Small ones show more rings.",
               [](Draft& d, const Value& v) { phaseOf(d).effectiveVariance = v.number; }),
        other(
            names.table, Type::path, "(none)",
            "File for `table`: an angle in degrees and a value of any unit in each line, separated by spaces or a "
            "comma, the angles rising from 0 to 180; # begins a comment. It is normalised, with a note of the factor.",
            [](Draft& d, const Value& v) { phaseOf(d).table = (d.folder / v.text).lexically_normal(); }),
    };
}

}  // namespace

std::vector<Key> phaseKeys() {
    return keysOf<phaseOfCloud>(ofClouds);
}

std::vector<Key> fieldPhaseKeys() {
    return keysOf<phaseOfField>(ofFields);
}

}  // namespace lumulus::scene
