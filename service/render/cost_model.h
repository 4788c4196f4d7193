#pragma once

#include <array>
#include <cstdint>

#include "service/values/requests.h"

namespace lumulus::service {

/// Foresees what a scene's work will cost from what it has cost lately: running means of milliseconds.
class CostModel {
  public:
    /// Where a deadline is short, the sides of pictures are divided by one of `reductions`, those of the sun's shadow
    /// volume by one of `sunReductions`.
    static constexpr std::array<int, 6> reductions{1, 2, 3, 4, 6, 8};
    static constexpr std::array<int, 4> sunReductions{1, 2, 3, 4};
    /// Share of the shadow volume's texels that are left by a reduction.
    static constexpr double sunShare(int reduction) { return 1.0 / (reduction * reduction * reduction); }

    /// Takes what a generation of photons cost.
    void traced(double milliseconds);
    /// Takes what `share` (0 to 1) of the texels of the sun's shadow volume cost.
    void lit(double milliseconds, double share);
    /// Takes what a frame cost: in total, and the part of it (`fixed`) that a view costs whatever its size.
    void drawn(double fixed, double total, std::uint64_t rays);
    /// Takes what encoding `pixels` cost.
    void encoded(Encoding encoding, double milliseconds, std::uint64_t pixels);

    double traceMs() const { return trace_.value; }
    double sunMs(double share) const { return sun_.value * share; }
    double drawMs(std::uint64_t views, std::uint64_t rays) const;
    double encodeMs(Encoding encoding, std::uint64_t pixels) const;
    /// The smallest reduction with which the sun's shadow volume is foreseen to take at most `milliseconds`, or the
    /// largest.
    int sunReductionFor(double milliseconds) const;
    /// The smallest reduction with which a frame is foreseen to take at most `milliseconds`; the largest where none is.
    /// `rays` of the whole frame; reduced, it has one a pixel.
    int reductionFor(double milliseconds, std::uint64_t views, std::uint64_t rays, std::uint64_t pixels,
                     Encoding encoding) const;

  private:
    struct Mean {
        double value = 0.0;
        bool known = false;
        void add(double x) {
            constexpr double newest = 0.3;  // share of the newest figure
            value = known ? value + newest * (x - value) : x;
            known = true;
        }
    };
    Mean trace_, sun_, fixed_, perRay_;
    std::array<Mean, encodings> encode_{};
};

}  // namespace lumulus::service
