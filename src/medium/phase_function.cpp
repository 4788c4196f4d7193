#include "medium/phase_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "medium/mie.h"
#include "medium/moments.h"
#include "medium/quadrature.h"
#include "scene/phase_table_file.h"

namespace lumulus::phase {

namespace {

using std::numbers::pi;

/// 1 − cos θ and 1 + cos θ, each with all its digits.
struct Chords {
    double minus;
    double plus;
};

double henyeyGreenstein(double g, Chords c) {
    const double a = std::abs(g);
    const double b = (1.0 - a) * (1.0 - a) + 2.0 * a * (g < 0.0 ? c.plus : c.minus);
    return (1.0 - a) * (1.0 + a) / (4.0 * pi * b * std::sqrt(b));
}

double draine(double g, double alpha, Chords c) {
    const double cosine = 1.0 - c.minus;
    return henyeyGreenstein(g, c) * (1.0 + alpha * cosine * cosine) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

double schlick(double k, Chords c) {
    const double a = std::abs(k);
    const double b = (1.0 - a) + a * (k < 0.0 ? c.plus : c.minus);
    return (1.0 - a) * (1.0 + a) / (4.0 * pi * b * b);
}

double powerLobe(int n, Chords c) {
    return (n + 1) / (4.0 * pi) * std::pow(0.5 * c.plus, n);
}

std::vector<double> mix(std::vector<double> a, const std::vector<double>& b, double weight) {
    for (std::size_t l = 0; l < a.size(); ++l) {
        a[l] = (1.0 - weight) * a[l] + weight * b[l];
    }
    return a;
}

void requireAsymmetry(double g, double limit, const char* why) {
    if (!(std::abs(g) < limit)) {
        throw InputError(fmt::format("phase g = {} is out of range", g), "phase.g",
                         fmt::format("give a value between -{0} and {0}{1}", limit, why));
    }
}

void requireDroplet(const scene::Phase& phase) {
    constexpr double least = 2.0, most = 50.0;
    if (phase.effectiveRadius >= least && phase.effectiveRadius <= most && phase.effectiveVariance > 0.0 &&
        phase.effectiveVariance <= 0.5)
        return;
    throw InputError(fmt::format("droplets of effective radius {} and variance {} are out of range",
                                 phase.effectiveRadius, phase.effectiveVariance),
                     "phase.effective_radius", "give a radius from 2 to 50 micrometres and a variance of at most 0.5");
}

TabulatedPhase tableOf(const std::filesystem::path& file) {
    try {
        scene::PhaseTable table = scene::readPhaseTable(file);
        for (double& angle : table.angles) angle *= pi / 180.0;
        return {std::move(table.angles), std::move(table.values)};
    } catch (const scene::PhaseTableError& e) {
        throw InputError(e.fault, e.place, e.mend);
    }
}

}  // namespace

DropletFit dropletFit(double diameter) {
    DropletFit fit;
    fit.gHg = std::exp(-0.0990567 / (diameter - 1.67154));
    fit.gDraine = std::exp(-2.20679 / (diameter + 3.91029) - 0.428934);
    fit.alpha = std::exp(3.62489 - 8.29288 / (diameter + 5.52825));
    fit.weight = std::exp(-0.599085 / (diameter - 0.641583) - 0.665888);
    return fit;
}

double schlickK(double g) {
    return g * (1.55 - 0.55 * g * g);
}

PhaseFunction::PhaseFunction(const scene::Phase& phase) : model_(phase.model) {
    switch (model_) {
        case scene::PhaseModel::henyeyGreenstein:
            requireAsymmetry(phase.g, 1.0, ", both excluded");
            g_ = phase.g;
            lobeWidth_ = std::min(lobeWidth_, 1.0 - std::abs(g_));
            break;
        case scene::PhaseModel::schlick:
            // k(g) = 1 at g = (√(1+4/0.55)−1)/2 = 0.93813
            requireAsymmetry(phase.g, 0.938, ", or the model henyey_greenstein, which is defined beyond");
            k_ = schlickK(phase.g);
            lobeWidth_ = std::min(lobeWidth_, std::sqrt(1.0 - std::abs(k_)));
            break;
        case scene::PhaseModel::droplet:
            if (!(phase.dropletDiameter >= 5.0 && phase.dropletDiameter <= 50.0)) {
                throw InputError(fmt::format("droplet diameter {} is out of range", phase.dropletDiameter),
                                 "phase.droplet_diameter", "give a diameter from 5 to 50 micrometres");
            }
            fit_ = dropletFit(phase.dropletDiameter);
            lobeWidth_ = std::min(lobeWidth_, 1.0 - fit_.gHg);
            break;
        case scene::PhaseModel::rayleigh:
        case scene::PhaseModel::hazy:
        case scene::PhaseModel::murky:
            break;
        case scene::PhaseModel::mie:
            requireDroplet(phase);
            table_ = mieColours(phase.effectiveRadius, phase.effectiveVariance).mean.front();
            lobeWidth_ = table_->lobeWidth();
            break;
        case scene::PhaseModel::table:
            table_ = tableOf(phase.table);
            lobeWidth_ = table_->lobeWidth();
            break;
    }
}

PhaseFunction::PhaseFunction(TabulatedPhase table)
    : model_(scene::PhaseModel::table), table_(std::move(table)), lobeWidth_(table_->lobeWidth()) {}

double PhaseFunction::evaluateAngle(double theta) const {
    if (table_) return table_->evaluate(theta);
    const double s = std::sin(0.5 * theta);
    const double c = std::cos(0.5 * theta);
    return evaluate(2.0 * s * s, 2.0 * c * c);
}

double PhaseFunction::evaluate(double oneMinusCos, double onePlusCos) const {
    const Chords c{oneMinusCos, onePlusCos};
    switch (model_) {
        case scene::PhaseModel::henyeyGreenstein:
            return henyeyGreenstein(g_, c);
        case scene::PhaseModel::schlick:
            return schlick(k_, c);
        case scene::PhaseModel::rayleigh:
            return draine(0.0, 1.0, c);
        case scene::PhaseModel::hazy:
            return 0.5 / (4.0 * pi) + 0.5 * powerLobe(8, c);
        case scene::PhaseModel::murky:
            return 0.5 / (4.0 * pi) + 0.5 * powerLobe(32, c);
        case scene::PhaseModel::droplet:
            return (1.0 - fit_.weight) * henyeyGreenstein(fit_.gHg, c) +
                   fit_.weight * draine(fit_.gDraine, fit_.alpha, c);
        case scene::PhaseModel::mie:
        case scene::PhaseModel::table:
            break;
    }
    return table_->evaluate(2.0 * std::atan2(std::sqrt(oneMinusCos), std::sqrt(onePlusCos)));
}

std::vector<double> PhaseFunction::moments(int count) const {
    const auto isotropic = [count] { return hgMoments(0.0, count); };
    switch (model_) {
        case scene::PhaseModel::henyeyGreenstein:
            return hgMoments(g_, count);
        case scene::PhaseModel::schlick:
            return schlickMoments(k_, count);
        case scene::PhaseModel::rayleigh:
            return draineMoments(0.0, 1.0, count);
        case scene::PhaseModel::hazy:
            return mix(isotropic(), powerLobeMoments(8, count), 0.5);
        case scene::PhaseModel::murky:
            return mix(isotropic(), powerLobeMoments(32, count), 0.5);
        case scene::PhaseModel::droplet:
            return mix(hgMoments(fit_.gHg, count), draineMoments(fit_.gDraine, fit_.alpha, count), fit_.weight);
        case scene::PhaseModel::mie:
        case scene::PhaseModel::table:
            break;
    }
    return table_->moments(0.0, pi, count);
}

double PhaseFunction::forwardFraction(double thetaCut) const {
    return forwardMoments(thetaCut, 1).front();
}

std::vector<double> PhaseFunction::forwardMoments(double thetaCut, int count) const {
    if (table_) return table_->moments(0.0, thetaCut, count);
    const auto density = [this](double theta) { return evaluateAngle(theta); };
    return legendreMoments(density, 0.0, thetaCut, 0.5 * lobeWidth_, count);
}

std::vector<double> PhaseFunction::panels(double begin, double end) const {
    constexpr double longest = 0.25;
    if (!table_) return anglePanels(begin, end, 0.5 * lobeWidth_, longest);
    std::vector<double> ends{begin};
    // cells of the table are short where it matters; several of them share a panel
    const double finest = 0.25 * lobeWidth_;
    for (const double angle : table_->angles())
        if (angle >= ends.back() + finest && angle <= end - finest) ends.push_back(angle);
    ends.push_back(end);
    return ends;
}

PhaseColours phaseColours(const scene::Phase& phase) {
    if (phase.model != scene::PhaseModel::mie) return {PhaseFunction(phase), {}};
    requireDroplet(phase);
    MieColours colours = mieColours(phase.effectiveRadius, phase.effectiveVariance);
    PhaseColours result{PhaseFunction(std::move(colours.mean.front())), {}};
    for (TabulatedPhase& channel : colours.channels) result.channels.emplace_back(std::move(channel));
    return result;
}

}  // namespace lumulus::phase
