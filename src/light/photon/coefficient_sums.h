#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gpu/commands.h"
#include "gpu/program.h"
#include "light/photon/copy_parts.h"
#include "light/photon/generation.h"
#include "light/photon/photon_map.h"
#include "shared/photon.h"

namespace lumulus::photon {

/// The integers that a photon map counts in: generations in the making, the ring of those that may be replaced, and
/// the exact sum of all. Counts of the sum stand for 2^baseExponent W.
class CoefficientSums {
  public:
    /// `coefficients` of one generation.
    CoefficientSums(gpu::Context& context, const Options& options, std::uint32_t coefficients);

    /// Goes on with the generations of another ring of as many slots: `parts` of them have their places here, and the
    /// rest is 0. Before the first generation.
    void goOnFrom(CoefficientSums& other, std::span<const BufferPart> parts);

    /// Goes on with the sum of so many generations, whose counts stand for 2^baseExponent W; none where there was no
    /// light. Before the first generation; without a ring.
    void goOnFrom(std::span<const std::int64_t> sum, int generations, std::optional<int> baseExponent,
                  std::uint64_t saturated);

    /// Goes on with a ring whose newest generation was the `kept`-th, and whose sum of `generations` is this one, in
    /// counts of 2^baseExponent W: each of them has the same share. Before the first generation.
    void goOnFromRing(std::span<const std::int64_t> sum, int generations, int kept, int baseExponent);

    /// Adds counts of 2^baseExponent W that stand for so many generations more; the unit stays, where there is one
    /// already. Without a ring, after the last generation.
    void add(std::span<const std::int64_t> counts, int generations, int baseExponent);

    std::uint32_t coefficients() const { return coefficients_; }
    bool hasUnit() const { return hasUnit_; }
    /// The sum's unit, once and for all.
    void setUnit(int baseExponent);
    int baseExponent() const { return baseExponent_; }
    /// From a generation's unit to the sum's.
    int shiftOf(int unitExponent) const;

    /// A buffer for the next generation, in counts of 2^unitExponent W: with the light of those before it in it, or,
    /// where the generation may be dropped (`apart`), without.
    const gpu::Buffer& begin(int unitExponent, bool apart);
    /// Records that the buffer of begin() holds, for the tracer to count.
    std::uint64_t& records() { return records_; }
    /// Begins a generation without light.
    void beginDark();
    /// The generation of begin() is finished: it counts from now on.
    void keep();
    /// It is not: nothing of it stays, if it was begun `apart` or nothing was in its buffer.
    void drop();
    /// Whether a generation has begun that is neither kept nor dropped.
    bool hasBegun() const { return begun_.has_value(); }

    /// Adds what was traced to the sum, unless the sum would be a copy of the one buffer that holds it all. In a ring
    /// that is done already: it does not count a generation that has begun.
    void settle();
    /// The same, whatever the sum would be.
    void settleAll();
    /// Counts and the watts that one stands for: of all generations, of the even or of the odd ones that are not in the
    /// sum yet. Call settle() before.
    Light all();
    Light half(bool even) const;

    int kept() const { return kept_; }
    const SplitCounts& splitCounts() const { return splitCounts_; }
    std::uint64_t saturated() const { return saturatedCount_; }
    const std::vector<gpu::Buffer>& slots() const { return slots_; }
    /// The sum, empty at first.
    const gpu::Buffer& startedSum();
    const PassLog& log() const { return log_; }

  private:
    /// A generation in the making.
    struct Begun {
        bool lit = true;
        bool apart = false;
        std::uint64_t recordsBefore = 0;
    };

    /// Whether a ring does not count yet what `generation_` holds.
    bool waitsForRing() const { return keepRing_ && begun_; }
    void makeRoom(int unitExponent);
    bool nextIsOdd() const { return split_ && kept_ % 2 == 1; }
    gpu::Buffer& target() { return nextIsOdd() ? oddGeneration_ : generation_; }
    bool targetIsEmpty() const;
    bool isAllUnsettled() const;
    double unsettledUnit() const;
    void clear(gpu::Buffer& buffer);
    void recordAdd(const gpu::Buffer& from, const gpu::Buffer& to, int shift);
    void run();

    gpu::Context& context_;
    bool keepRing_, split_;
    std::uint32_t coefficients_;
    gpu::Program<shared::AccumulatePush> program_;
    gpu::Buffer generation_, oddGeneration_, saturated_;
    std::optional<gpu::Buffer> apart_;  ///< of a generation that may be dropped
    std::optional<gpu::Buffer> sum_;    ///< from when there is something to add together
    std::vector<gpu::Buffer> slots_;
    gpu::Commands commands_;

    int kept_ = 0;  ///< generations so far
    int baseExponent_ = 0;
    bool hasUnit_ = false;
    std::optional<Begun> begun_;
    std::optional<int> unsettled_;  ///< unit exponent of what `generation_` holds and the sum does not
    int unsettledGenerations_ = 0;
    std::uint64_t records_ = 0;  ///< of what is unsettled
    SplitCounts splitCounts_;    ///< of what is unsettled
    std::uint64_t saturatedCount_ = 0;
    PassLog log_;
};

}  // namespace lumulus::photon
