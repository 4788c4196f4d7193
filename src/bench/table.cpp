#include "bench/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bench/curve.h"

namespace lumulus::bench {
namespace {

constexpr std::array<double, 2> targets{1e-2, 3e-3};

struct Clock {
    const char* name;
    Spread Row::*seconds;
};

constexpr std::array<Clock, 2> clocks{{{"without warm-up", &Row::warmSeconds}, {"whole", &Row::seconds}}};

/// Time of one method to reach the target. Path tracers are extrapolated beyond the last point, which also tells their
/// time before the first sample.
TimeToError timeOf(std::span<const Row> rows, Method method, const Clock& clock, double target) {
    std::vector<CurvePoint> curve;
    double fixed = 0.0;
    for (const Row& row : rows) {
        if (row.method != method) continue;
        curve.push_back({(row.*clock.seconds).mean, row.relMse.mean});
        fixed = (row.*clock.seconds).mean - row.warmSeconds.mean;
    }
    return timeToReach(curve, target, method == Method::render ? std::nullopt : std::optional(fixed));
}

std::string timeText(const TimeToError& time) {
    switch (time.how) {
        case Reached::measured:
            return fmt::format("{:.3g} s", time.seconds);
        case Reached::atFirst:
            return fmt::format("≤ {:.3g} s", time.seconds);
        case Reached::extrapolated:
            return fmt::format("~{:.3g} s", time.seconds);
        case Reached::never:
            break;
    }
    return "not reached";
}

/// The ratio of the path tracer's time to that of `render`.
std::string ratioText(const TimeToError& render, const TimeToError& tracer) {
    if (render.how == Reached::never || tracer.how == Reached::never) return "-";
    const bool renderBound = render.how == Reached::atFirst, tracerBound = tracer.how == Reached::atFirst;
    const double ratio = tracer.seconds / render.seconds;
    if (renderBound && tracerBound) return "-";  // a ratio of two upper bounds says nothing
    return fmt::format("{}{:.3g}", renderBound ? "≥ " : tracerBound ? "≤ " : "", ratio);
}

std::string rowText(const Row& row) {
    return fmt::format("{:<12}{:>10.3f}{:>10.3f}{:>12.4g}  {:>9.3g} ±{:<8.2g}{:>9.3g}{:>8.3f}{:>+9.2f} %\n",
                       nameOf(row.method), row.warmSeconds.mean, row.seconds.mean, row.amount.mean, row.relMse.mean,
                       row.relMse.deviation, row.rmse.mean, row.flip.mean, 1e2 * row.relativeBias.mean);
}

}  // namespace

std::string tableText(std::span<const Row> rows, std::optional<double> floor) {
    std::string text = fmt::format("{:<12}{:>10}{:>10}{:>12}  {:>9} {:<9}{:>9}{:>8}{:>11}\n", "method", "warm s",
                                   "whole s", "photons/spp", "relMSE", "", "RMSE", "FLIP", "bias");
    for (const Row& row : rows) text += rowText(row);
    text += floor ? fmt::format("reference noise: relMSE {:.3g}, subtracted\n", *floor)
                  : std::string("reference noise: unknown, it has no variance layers; nothing subtracted\n");
    std::vector<Method> tracers{Method::pathTracer};
    if (std::ranges::any_of(rows, [](const Row& row) { return row.method == Method::cycles; }))
        tracers.push_back(Method::cycles);
    text += fmt::format("\n{:<28}{:>14}", "time to reach", nameOf(Method::render));
    for (const Method tracer : tracers) text += fmt::format("{:>14}{:>10}", nameOf(tracer), "ratio");
    text += "\n";
    for (const double target : targets) {
        for (const Clock& clock : clocks) {
            const TimeToError render = timeOf(rows, Method::render, clock, target);
            text += fmt::format("relMSE {:<6g} {:<14}{:>14}", target, clock.name, timeText(render));
            for (const Method method : tracers) {
                const TimeToError tracer = timeOf(rows, method, clock, target);
                text += fmt::format("{:>14}{:>10}", timeText(tracer), ratioText(render, tracer));
            }
            text += "\n";
        }
    }
    return text + "~ extrapolated: error falls as 1/samples; ≤ the first measurement is there already\n";
}

}  // namespace lumulus::bench
