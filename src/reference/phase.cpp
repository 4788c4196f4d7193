#include "reference/phase.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/error.h"
#include "reference/droplets.h"
#include "scene/phase_table_file.h"

namespace lumulus::reference {
namespace {

constexpr double inverseFourPi = 0.25 * glm::one_over_pi<double>();

/// Henyey and Greenstein 1941, by (1−g)² + 2g(1−c), which does not cancel.
double henyeyGreenstein(double g, double oneMinusCos) {
    const double base = (1.0 - g) * (1.0 - g) + 2.0 * g * oneMinusCos;
    return inverseFourPi * (1.0 - g) * (1.0 + g) / (base * std::sqrt(base));
}

/// 1 − c = 2w(1−g)²(1+gu)/D², w = 1−u, D = (1−g)+2gu: the inverse of the cumulative distribution without a branch.
double sampleHenyeyGreenstein(double g, double u) {
    if (g < 0.0) return 2.0 - sampleHenyeyGreenstein(-g, u);
    const double share = (1.0 - g) / ((1.0 - g) + 2.0 * g * u);
    return std::min(2.0, 2.0 * (1.0 - u) * share * share * (1.0 + g * u));
}

/// Blasi, Le Saëc and Schlick 1993.
double schlick(double k, double oneMinusCos) {
    const double base = (1.0 - k) + k * oneMinusCos;
    return inverseFourPi * (1.0 - k) * (1.0 + k) / (base * base);
}

double sampleSchlick(double k, double u) {
    if (k < 0.0) return 2.0 - sampleSchlick(-k, u);
    return 2.0 * (1.0 - k) * (1.0 - u) / ((1.0 - k) + 2.0 * k * u);
}

/// ¾(1 + c²): c³ + 3c = 8u − 4 by Cardano.
double sampleRayleigh(double u) {
    const double half = 4.0 * u - 2.0;
    const double root = std::cbrt(half + std::copysign(std::sqrt(half * half + 1.0), half));
    return std::clamp(1.0 - (root - 1.0 / root), 0.0, 2.0);
}

/// Half isotropic, half a lobe ((1+c)/2)^power (Nishita 1987): both of Lorenz–Mie's approximations.
double lobe(double power, double oneMinusCos) {
    return inverseFourPi * (0.5 + 0.5 * (power + 1.0) * std::pow(1.0 - 0.5 * oneMinusCos, power));
}

double sampleLobe(double power, Random& random) {
    const double u = random.uniform();
    if (u < 0.5) return 4.0 * u;
    return 2.0 * (1.0 - std::pow(2.0 * u - 1.0, 1.0 / (power + 1.0)));
}

/// Draine 2003.
double draine(double g, double alpha, double oneMinusCos) {
    const double c = 1.0 - oneMinusCos;
    return henyeyGreenstein(g, oneMinusCos) * (1.0 + alpha * c * c) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

/// Rejection from Henyey–Greenstein; accepts at least a third.
double sampleDraine(double g, double alpha, Random& random) {
    for (;;) {
        const double oneMinusCos = sampleHenyeyGreenstein(g, random.uniform());
        const double c = 1.0 - oneMinusCos;
        if (random.uniform() * (1.0 + alpha) < 1.0 + alpha * c * c) return oneMinusCos;
    }
}

constexpr double hazyPower = 8.0, murkyPower = 32.0;

/// A file's values, linear in the angle there and so more densely in 1 − cos θ.
std::vector<PhaseValues> valuesOf(const std::filesystem::path& file) {
    std::vector<double> places, values;
    try {
        const scene::PhaseTable table = scene::readPhaseTable(file);
        constexpr int parts = 16;
        for (std::size_t i = 0; i + 1 < table.angles.size(); ++i)
            for (int k = 0; k < parts; ++k) {
                const double t = static_cast<double>(k) / parts;
                const double half = 0.5 * glm::radians(glm::mix(table.angles[i], table.angles[i + 1], t));
                places.push_back(2.0 * std::sin(half) * std::sin(half));
                values.push_back(glm::mix(table.values[i], table.values[i + 1], t));
            }
        places.push_back(2.0);
        values.push_back(table.values.back());
    } catch (const scene::PhaseTableError& e) {
        throw InputError(e.fault, e.place, e.mend);
    }
    return {PhaseValues(std::move(places), std::move(values))};
}

}  // namespace

PhaseFunction::PhaseFunction(const scene::Phase& phase) : model_(phase.model), g_(phase.g) {
    if (model_ == scene::PhaseModel::schlick) g_ = phase.g * (1.55 - 0.55 * phase.g * phase.g);
    if (model_ == scene::PhaseModel::droplet) {
        // Jendersie and d'Eon 2023, fit for 5 to 50 µm
        const double d = phase.dropletDiameter;
        g_ = std::exp(-0.0990567 / (d - 1.67154));
        draineG_ = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
        draineAlpha_ = std::exp(3.62489 - 8.29288 / (d + 5.52825));
        draineShare_ = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
        if (!(d >= 5.0 && d <= 50.0)) {
            throw InputError("no fit for droplets of this diameter", "cloud.phase.droplet_diameter", "give 5 to 50 µm");
        }
    }
    if (model_ == scene::PhaseModel::mie) {
        if (!(phase.effectiveRadius >= 2.0 && phase.effectiveRadius <= 50.0) ||
            !(phase.effectiveVariance > 0.0 && phase.effectiveVariance <= 0.5))
            throw InputError("no droplets of this size", "cloud.phase.effective_radius", "give a radius of 2 to 50 µm");
        values_ = makeDroplets(phase.effectiveRadius, phase.effectiveVariance).colours;
    }
    if (model_ == scene::PhaseModel::table) values_ = valuesOf(phase.table);
    if (!(std::abs(g_) < 1.0)) {
        throw InputError("the peak of the phase function is too narrow", "cloud.phase.g", "give a |g| nearer to 0");
    }
}

PhaseFunction PhaseFunction::cornetteShanks(double g) {
    PhaseFunction phase{scene::Phase{}};
    // Draine's function with α = 1
    phase.model_ = scene::PhaseModel::droplet;
    phase.draineG_ = g;
    phase.draineAlpha_ = 1.0;
    phase.draineShare_ = 1.0;
    return phase;
}

double PhaseFunction::evaluate(double oneMinusCos) const {
    switch (model_) {
        case scene::PhaseModel::henyeyGreenstein:
            return henyeyGreenstein(g_, oneMinusCos);
        case scene::PhaseModel::schlick:
            return schlick(g_, oneMinusCos);
        case scene::PhaseModel::rayleigh:
            return 0.75 * inverseFourPi * (1.0 + (1.0 - oneMinusCos) * (1.0 - oneMinusCos));
        case scene::PhaseModel::hazy:
            return lobe(hazyPower, oneMinusCos);
        case scene::PhaseModel::murky:
            return lobe(murkyPower, oneMinusCos);
        case scene::PhaseModel::droplet:
            break;
        case scene::PhaseModel::mie:
        case scene::PhaseModel::table:
            return values_.back().evaluate(oneMinusCos);
    }
    return (1.0 - draineShare_) * henyeyGreenstein(g_, oneMinusCos) +
           draineShare_ * draine(draineG_, draineAlpha_, oneMinusCos);
}

double PhaseFunction::peak() const {
    return std::max(evaluate(0.0), evaluate(2.0));
}

double PhaseFunction::sample(Random& random) const {
    switch (model_) {
        case scene::PhaseModel::henyeyGreenstein:
            return sampleHenyeyGreenstein(g_, random.uniform());
        case scene::PhaseModel::schlick:
            return sampleSchlick(g_, random.uniform());
        case scene::PhaseModel::rayleigh:
            return sampleRayleigh(random.uniform());
        case scene::PhaseModel::hazy:
            return sampleLobe(hazyPower, random);
        case scene::PhaseModel::murky:
            return sampleLobe(murkyPower, random);
        case scene::PhaseModel::droplet:
            break;
        case scene::PhaseModel::mie:
        case scene::PhaseModel::table:
            return values_.back().invert(random.uniform());
    }
    if (random.uniform() < draineShare_) return sampleDraine(draineG_, draineAlpha_, random);
    return sampleHenyeyGreenstein(g_, random.uniform());
}

glm::dvec3 PhaseFunction::hue(double oneMinusCos) const {
    if (!coloured()) return glm::dvec3(1.0);
    const glm::dvec3 rgb(values_[0].evaluate(oneMinusCos), values_[1].evaluate(oneMinusCos),
                         values_[2].evaluate(oneMinusCos));
    return rgb / values_[3].evaluate(oneMinusCos);
}

glm::dvec3 turned(const glm::dvec3& direction, double oneMinusCos, Random& random) {
    // a point in the unit disc at azimuth φ gives cos 2φ and sin 2φ without a square root
    double x = 0.0, y = 0.0, square = 0.0;
    do {
        x = 2.0 * random.uniform() - 1.0;
        y = 2.0 * random.uniform() - 1.0;
        square = x * x + y * y;
    } while (square >= 1.0 || square < 1e-12);
    const double sine = std::sqrt(oneMinusCos * (2.0 - oneMinusCos)) / square;
    const double across = sine * (x * x - y * y), along = sine * 2.0 * x * y;
    // basis about the direction: Duff et al. 2017
    const double sign = std::copysign(1.0, direction.z);
    const double a = -1.0 / (sign + direction.z);
    const double b = direction.x * direction.y * a;
    const glm::dvec3 tangent(1.0 + sign * direction.x * direction.x * a, sign * b, -sign * direction.x);
    const glm::dvec3 bitangent(b, sign + direction.y * direction.y * a, -direction.y);
    const glm::dvec3 result = (1.0 - oneMinusCos) * direction + (across * tangent + along * bitangent);
    // one Newton step keeps the length at 1 over any number of scattering events
    return result * (1.5 - 0.5 * glm::dot(result, result));
}

}  // namespace lumulus::reference
