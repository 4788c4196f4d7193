#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "medium/phase_function.h"
#include "medium/quadrature.h"

namespace lumulus::test {

using std::numbers::pi;

constexpr double degree = pi / 180.0;

struct PhaseCase {
    std::string name;
    scene::Phase phase;
};

inline void PrintTo(const PhaseCase& c, std::ostream* out) {
    *out << c.name;
}

inline PhaseCase hgCase(double g) {
    return {"HG " + std::to_string(g), {scene::PhaseModel::henyeyGreenstein, g, 20.0}};
}

inline std::vector<PhaseCase> hgCases() {
    std::vector<PhaseCase> cases;
    for (const double g : {-0.9999, -0.999, -0.5, 0.0, 1e-6, 0.3, 0.85, 0.99, 0.9999}) {
        cases.push_back(hgCase(g));
    }
    return cases;
}

/// The models that are sampled by table.
inline std::vector<PhaseCase> tableCases() {
    return {{"Schlick .6", {scene::PhaseModel::schlick, 0.6, 20.0}},
            {"Schlick .93", {scene::PhaseModel::schlick, 0.93, 20.0}},
            {"Schlick -.4", {scene::PhaseModel::schlick, -0.4, 20.0}},
            {"Rayleigh", {scene::PhaseModel::rayleigh, 0.0, 20.0}},
            {"hazy", {scene::PhaseModel::hazy, 0.0, 20.0}},
            {"murky", {scene::PhaseModel::murky, 0.0, 20.0}},
            {"droplet 5", {scene::PhaseModel::droplet, 0.0, 5.0}},
            {"droplet 20", {scene::PhaseModel::droplet, 0.0, 20.0}},
            {"droplet 50", {scene::PhaseModel::droplet, 0.0, 50.0}}};
}

inline std::vector<PhaseCase> allCases() {
    std::vector<PhaseCase> cases = hgCases();
    for (const PhaseCase& c : tableCases()) {
        cases.push_back(c);
    }
    return cases;
}

/// 1 − cos θ without cancellation.
inline double oneMinusCosine(double theta) {
    const double s = std::sin(0.5 * theta);
    return 2.0 * s * s;
}

/// ∫ f(θ) 2π sin θ dθ over [begin,end], for lobes of the given width at the poles.
template <typename Function>
double integrateSphere(const Function& f, double begin, double end, double width) {
    const std::vector<double> ends = phase::anglePanels(begin, end, 0.5 * width, 0.2);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        sum += phase::integratePanel(ends[i], ends[i + 1],
                                     [&](double theta) { return 2.0 * pi * std::sin(theta) * f(theta); });
    }
    return sum;
}

}  // namespace lumulus::test
