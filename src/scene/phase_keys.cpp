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

Phase& phaseOf(Draft& d) {
    return d.scene.clouds.at(d.entry).phase;
}

}  // namespace

std::vector<Key> phaseKeys() {
    return {
        choice("cloud.phase.model",
               {"henyey-greenstein", "hg", "schlick", "rayleigh", "hazy", "murky", "droplet", "mie", "table"},
               "\"henyey-greenstein\"",
               "`hg` is short for `henyey-greenstein`; `schlick` approximates it; `hazy` and `murky` are Nishita's "
               "(1987); `droplet` is the fit of Jendersie and d'Eon (2023) for fog and clouds; `mie` is exact for "
               "droplets of water, with fogbow and glory (docs/droplets.md); `table` reads a file.",
               [](Draft& d, const Value& v) { phaseOf(d).model = phaseModels.at(v.choice); }),
        number("cloud.phase.g", {-1.0, 1.0, true, true}, "0.85",
               "Mean cosine of scattering, for `henyey-greenstein` and `schlick`.",
               [](Draft& d, const Value& v) { phaseOf(d).g = v.number; }),
        number("cloud.phase.droplet_diameter", {5.0, 50.0}, "20.0",
               "Diameter of droplets in micrometres, for `droplet`.",
               [](Draft& d, const Value& v) { phaseOf(d).dropletDiameter = v.number; }),
        number("cloud.phase.effective_radius", {2.0, 50.0}, "10.0",
               "Effective radius of droplets in micrometres, for `mie`: the mean of r³ over the mean of r².",
               [](Draft& d, const Value& v) { phaseOf(d).effectiveRadius = v.number; }),
        number("cloud.phase.effective_variance", {0.01, 0.5}, "0.1",
               "Effective variance of the gamma distribution of radii, for `mie`. Small ones show more rings.",
               [](Draft& d, const Value& v) { phaseOf(d).effectiveVariance = v.number; }),
        other(
            "cloud.phase.table", Type::path, "(none)",
            "File for `table`: an angle in degrees and a value of any unit in each line, separated by spaces or a "
            "comma, the angles rising from 0 to 180; # begins a comment. It is normalised, with a note of the factor.",
            [](Draft& d, const Value& v) { phaseOf(d).table = (d.folder / v.text).lexically_normal(); }),
    };
}

}  // namespace lumulus::scene
