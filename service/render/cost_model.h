#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "service/values/requests.h"

namespace lumulus::service {

/// Foresees what a scene's work will cost from what it has cost lately: medians of the last milliseconds, so that a
/// frame from which the machine took its cores does not make those after it coarse.
class CostModel {
  public:
    /// What a frame has to do.
    struct Work {
        std::uint64_t views = 1;
        std::uint64_t lights = 0;                      ///< views that need light towards an eye of their own
        std::uint64_t rays = 0;                        ///< of all views
        std::uint64_t enlarged = 0;                    ///< pixels of reduced pictures, after they were enlarged
        std::optional<std::uint64_t> lightsReduced{};  ///< where reduced pictures need another number of `lights`
    };
    /// Milliseconds that it took.
    struct Spent {
        double light = 0.0, rays = 0.0, enlarging = 0.0;
        double total = 0.0;  ///< with what a view takes whatever its size
    };

    /// Where a deadline is short, the sides of pictures are divided by one of `reductions`, those of the sun's shadow
    /// volume by one of `sunReductions`.
    static constexpr std::array<int, 6> reductions{1, 2, 3, 4, 6, 8};
    static constexpr std::array<int, 4> sunReductions{1, 2, 3, 4};
    /// Share of the shadow volume's texels that are left by a reduction.
    static constexpr double sunShare(int reduction) { return 1.0 / (reduction * reduction * reduction); }

    /// The work of a frame of so many pixels, with the sides of its pictures divided: they have one ray a pixel then.
    static Work reduced(Work work, int reduction, std::uint64_t pixels);

    /// Takes what a generation of photons cost.
    void traced(double milliseconds);
    /// Of another density nobody knows what tracing costs.
    void forgetTracing() { trace_ = {}; }
    /// Takes what `share` (0 to 1) of the texels of the sun's shadow volume cost.
    void lit(double milliseconds, double share);
    /// Takes what a frame cost.
    void drawn(const Work& work, const Spent& spent);
    /// Takes what encoding `pixels` cost.
    void encoded(Encoding encoding, double milliseconds, std::uint64_t pixels);

    double traceMs() const { return trace_.value(); }
    double sunMs(double share) const { return sun_.value() * share; }
    double drawMs(const Work& work) const;
    double encodeMs(Encoding encoding, std::uint64_t pixels) const;
    /// The smallest reduction with which the sun's shadow volume is foreseen to take at most `milliseconds`, or the
    /// largest.
    int sunReductionFor(double milliseconds) const;
    /// The smallest reduction with which a frame is foreseen to take at most `milliseconds`; the largest where none is.
    /// `work` is that of the whole frame of so many pixels.
    int reductionFor(double milliseconds, const Work& work, std::uint64_t pixels, Encoding encoding) const;

  private:
    /// The median of the last figures, or half of the newest where that is more: a change shows at once.
    class Recent {
      public:
        void add(double figure);
        double value() const { return median_; }
        bool isKnown() const { return count_ > 0; }

      private:
        std::array<double, 5> last_{};
        std::size_t count_ = 0;  // of all that were added
        double median_ = 0.0;
    };
    /// Of whole pictures, and of reduced ones, whose light is coarse. Until these are known, of whole ones.
    struct Figures {
        Recent view, light;
    };
    Recent trace_, sun_, ray_, enlarging_;
    Figures whole_, reduced_;
    std::array<Recent, encodings> encode_{};
};

}  // namespace lumulus::service
