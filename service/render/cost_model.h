#pragma once

#include <array>
#include <cstdint>

#include "service/protocol/requests.h"

namespace lumulus::service {

/// What a scene's work has cost lately, to foresee what it will: running means of milliseconds.
class CostModel {
  public:
    /// Sides of pictures are divided by one of these where a deadline is short; those of the sun's grid by one of some.
    static constexpr std::array<int, 6> reductions{1, 2, 3, 4, 6, 8};
    static constexpr std::array<int, 4> sunReductions{1, 2, 3, 4};
    /// Of the sun's texels that are left.
    static constexpr double sunShare(int reduction) { return 1.0 / (reduction * reduction * reduction); }

    void traced(double milliseconds);
    /// Of the sun's grid, whole (`share` 1), in part, or reduced: the share of its texels that were made.
    void lit(double milliseconds, double share);
    /// `fixed`: of a view, whatever its size.
    void drawn(double fixed, double total, std::uint64_t rays);
    void encoded(Encoding encoding, double milliseconds, std::uint64_t pixels);

    double traceMs() const { return trace_.value; }
    double sunMs(double share) const { return sun_.value * share; }
    double drawMs(std::uint64_t views, std::uint64_t rays) const;
    double encodeMs(Encoding encoding, std::uint64_t pixels) const;
    /// The smallest reduction with which the sun's grid is foreseen to take at most `milliseconds`, or the largest.
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
