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

/// Part of the time left that the first generation may take, and the least that it gets [s]. Where it does not end by
/// then, its photons are divided, twice at most: down to as many as a CPU walks in one round.
constexpr double firstShare = 0.25, leastForFirst = 0.8;
constexpr std::uint64_t divisor = 64, fewest = 64;
constexpr int divisions = 2;

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
            if (reached_.generations == 0)
                traceFirst();
            else if (!traceOne(inTime()))
                reached_.stop = Stop::seconds;
            if (reached_.stop == Stop::seconds) break;
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

    /// Ends a generation that would end too late, if there is a limit.
    CutOff inTime() const {
        if (!goal_.seconds) return {};
        return {[this] { return timeIsUp(0.0); }};
    }

    /// A generation of the scene's photons, if it ends within its share of the time, or of as many as do.
    void traceFirst() {
        for (int left = goal_.seconds ? divisions : 0; !tryFirst(left == 0); --left)
            reached_.photonsEach = renderer_.shrinkGenerations(left > 1 ? divisor : ~std::uint64_t{0}, fewest);
    }

    /// `last`: whatever there is of it then is kept.
    bool tryFirst(bool last) {
        if (!goal_.seconds) return traceOne({});
        const double now = elapsed_();
        const double end = now + std::max(leastForFirst, firstShare * (*goal_.seconds - goal_.afterDrawing - now));
        bool cut = false;
        const auto due = [&] { return cut = elapsed_() >= end; };
        if (!traceOne({due, last})) return false;
        reached_.unfinished = cut;
        if (cut) reached_.stop = Stop::seconds;
        return true;
    }

    bool traceOne(const CutOff& cutOff) {
        const double start = elapsed_();
        if (!renderer_.traceGeneration(cutOff)) return false;
        const double seconds = elapsed_() - start;
        ++reached_.generations;
        // the first generation includes compilation
        each_ = reached_.generations <= 2 ? seconds : 0.7 * each_ + 0.3 * seconds;
        if (reached_.noise) *reached_.noise *= (reached_.generations - 1.0) / reached_.generations;
        return true;
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
    if (renderer.generationsWanted() == 0) {
        Reached nothing;
        nothing.noise = 0.0;
        return nothing;
    }
    return Run(renderer, goal, elapsed, report).trace();
}

void traceAll(Renderer& renderer, const Report& report) {
    const auto generations = static_cast<std::uint64_t>(renderer.generationsWanted());
    for (std::uint64_t done = 0; done < generations; ++done) {
        report("photons", done, generations);
        stopIfInterrupted();
        renderer.traceGeneration();
    }
    if (generations > 0) report("photons", generations, generations);
}

}  // namespace lumulus::progressive
