#include "progressive/trace_until.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/interrupt.h"
#include "progressive/noise.h"

namespace lumulus::progressive {

namespace {

/// Factors by which the generations grow until the noise is estimated again. An estimate costs as much as one or two
/// generations. More photons also give a finer light field, so noise falls more slowly than 1/photons.
constexpr double soonest = 1.3, latest = 4.0;

int nextLook(int generations, double noise, const Goal& goal) {
    const double wanted = goal.targetError ? generations * noise / *goal.targetError : latest * generations;
    const double next = std::ceil(std::clamp(wanted, soonest * generations, latest * generations));
    return static_cast<int>(std::min(next, 1e9));
}

class Run {
  public:
    Run(Renderer& renderer, const Goal& goal, const std::function<double()>& elapsed, const Report& report)
        : renderer_(renderer), goal_(goal), elapsed_(elapsed), report_(report) {}

    Reached trace() {
        report_("photons", 0, percent);
        do {
            stopIfInterrupted();
            traceOne();
            if (timeIsUp(each_)) {
                reached_.stop = Stop::seconds;
            } else if (reached_.generations >= nextLook_) {
                look();
                if (goal_.targetError && *reached_.noise <= *goal_.targetError)
                    reached_.stop = Stop::targetError;
                else if (timeIsUp(each_))
                    reached_.stop = Stop::seconds;
            }
            tell();
        } while (reached_.stop == Stop::photons);
        report_("photons", percent, percent);
        return reached_;
    }

  private:
    static constexpr std::uint64_t percent = 100;

    Renderer& renderer_;
    const Goal& goal_;
    const std::function<double()>& elapsed_;
    const Report& report_;
    Reached reached_;
    int nextLook_ = 2;
    double each_ = 0.0;      // seconds of a generation
    double forecast_ = 0.0;  // seconds of drawing

    void traceOne() {
        const double start = elapsed_();
        renderer_.traceGeneration();
        const double seconds = elapsed_() - start;
        ++reached_.generations;
        // the first generation includes compilation
        each_ = reached_.generations <= 2 ? seconds : 0.7 * each_ + 0.3 * seconds;
        if (reached_.noise) *reached_.noise *= (reached_.generations - 1.0) / reached_.generations;
    }

    bool timeIsUp(double next) const {
        return goal_.seconds && elapsed_() + next + forecast_ + goal_.afterDrawing > *goal_.seconds;
    }

    void look() {
        const double start = elapsed_();
        const Preview preview = renderer_.preview();
        forecast_ = preview.forecastSeconds;
        reached_.noise = noiseOf(preview, reached_.generations);
        nextLook_ = nextLook(reached_.generations, *reached_.noise, goal_);
        reached_.previewSeconds += elapsed_() - start;
    }

    void tell() const {
        double share = goal_.seconds ? (elapsed_() + forecast_) / *goal_.seconds : 0.0;
        if (goal_.targetError && reached_.noise) share = std::max(share, *goal_.targetError / *reached_.noise);
        report_("photons", static_cast<std::uint64_t>(std::min(share, 0.99) * static_cast<double>(percent)), percent);
    }
};

}  // namespace

const char* nameOf(Stop stop) {
    switch (stop) {
        case Stop::seconds:
            return "seconds";
        case Stop::targetError:
            return "target-error";
        case Stop::photons:
            break;
    }
    return "photons";
}

Reached traceUntil(Renderer& renderer, const Goal& goal, const std::function<double()>& elapsed, const Report& report) {
    if (renderer.generationsWanted() == 0) return {Stop::photons, 0, 0.0, 0.0};
    return Run(renderer, goal, elapsed, report).trace();
}

}  // namespace lumulus::progressive
