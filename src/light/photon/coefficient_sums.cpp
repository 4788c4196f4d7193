#include "light/photon/coefficient_sums.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <string>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/accumulate.comp.h"
}  // namespace spirv

using gpu::Buffer;
using gpu::linearGroups;
using gpu::Memory;

/// Records that generations may leave together before the sum takes them: half of what requireCountable() allows.
constexpr std::uint64_t settleBeyond = 1ULL << 37U;

}  // namespace

CoefficientSums::CoefficientSums(gpu::Context& context, const Options& options, std::uint32_t coefficients)
    : context_(context),
      keepRing_(options.keepRing),
      split_(options.splitGenerations),
      coefficients_(coefficients),
      program_(context, "accumulate", spirv::accumulate_comp),
      generation_(context, "generation", coefficients * sizeof(std::int64_t), Memory::device),
      oddGeneration_(context, "odd generation", split_ ? coefficients * sizeof(std::int64_t) : 0, Memory::device),
      saturated_(context, "saturated", 2 * sizeof(std::uint32_t), Memory::host),
      commands_(context) {
    if (!keepRing_) return;
    for (int i = 0; i < options.generations; ++i)
        slots_.emplace_back(context, "ring slot " + std::to_string(i), coefficients * sizeof(std::int64_t),
                            Memory::device);
    commands_.begin();
    for (Buffer& slot : slots_) commands_.fill(slot, 0);
    commands_.submit();
    commands_.wait();
}

void CoefficientSums::setUnit(int baseExponent) {
    baseExponent_ = baseExponent;
    hasUnit_ = true;
}

void CoefficientSums::goOnFrom(CoefficientSums& other, std::span<const BufferPart> parts) {
    assert(keepRing_ && kept_ == 0 && slots_.size() == other.slots_.size());
    kept_ = other.kept_;
    baseExponent_ = other.baseExponent_;
    hasUnit_ = other.hasUnit_;
    saturatedCount_ = other.saturatedCount_;
    for (std::size_t i = 0; i < slots_.size(); ++i) copyParts(context_, other.slots_[i], slots_[i], parts);
    copyParts(context_, other.startedSum(), startedSum(), parts);
}

void CoefficientSums::goOnFrom(std::span<const std::int64_t> sum, int generations, std::optional<int> baseExponent,
                               std::uint64_t saturated) {
    assert(!keepRing_ && kept_ == 0 && sum.size() == coefficients_);
    kept_ = generations;
    if (baseExponent) setUnit(*baseExponent);
    saturatedCount_ = saturated;
    gpu::upload(context_, startedSum(), sum);
}

void CoefficientSums::goOnFromRing(std::span<const std::int64_t> sum, int generations, int kept, int baseExponent) {
    assert(keepRing_ && kept_ == 0 && sum.size() == coefficients_ && generations <= kept);
    assert(static_cast<std::size_t>(generations) <= slots_.size());
    setUnit(baseExponent);
    kept_ = kept;
    gpu::upload(context_, startedSum(), sum);
    std::vector<std::int64_t> share(sum.size());
    for (int n = 0; n < generations; ++n) {
        // integers whose sum is exact: what is over goes to the first ones
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const std::int64_t over = sum[i] % generations;
            share[i] = sum[i] / generations + (n < std::abs(over) ? (over > 0) - (over < 0) : 0);
        }
        const auto slot = static_cast<std::size_t>(kept - generations + n) % slots_.size();
        gpu::upload(context_, slots_[slot], std::span<const std::int64_t>(share));
    }
}

void CoefficientSums::add(std::span<const std::int64_t> counts, int generations, int baseExponent) {
    constexpr std::int64_t limit = 0x1FFFFFFFFFFFFFFF;  // as in accumulate.comp
    assert(!keepRing_ && !begun_ && counts.size() == coefficients_ && (!hasUnit_ || baseExponent_ == baseExponent));
    settleAll();
    setUnit(baseExponent);
    auto sum = gpu::download<std::int64_t>(context_, startedSum());
    for (std::size_t i = 0; i < counts.size(); ++i) sum[i] = std::clamp(sum[i] + counts[i], -limit, limit);
    gpu::upload(context_, startedSum(), std::span<const std::int64_t>(sum));
    kept_ += generations;
}

int CoefficientSums::shiftOf(int unitExponent) const {
    return unitExponent - std::countr_zero(static_cast<unsigned>(shared::COEFFICIENT_SCALE)) - baseExponent_;
}

void CoefficientSums::clear(Buffer& buffer) {
    commands_.begin();
    commands_.fill(buffer, 0);
    commands_.submit();
    commands_.wait();
}

/// Clears the generation's buffer, where it does not hold light in the same unit that the sum can take later, with room
/// for more. A ring has to know its generations one by one; where they are rounded into it, so does a sum that is to
/// have the same bits.
void CoefficientSums::makeRoom(int unitExponent) {
    const bool exact = shiftOf(unitExponent) >= 0 || split_;
    if (unsettled_ == unitExponent && exact && !keepRing_ && records_ <= settleBeyond) return;
    settleAll();
    clear(generation_);
    if (split_) clear(oddGeneration_);
    unsettled_ = unitExponent;
    records_ = 0;
}

bool CoefficientSums::targetIsEmpty() const {
    if (!split_) return unsettledGenerations_ == 0;
    return (nextIsOdd() ? splitCounts_.odd : splitCounts_.even) == 0;
}

const Buffer& CoefficientSums::begin(int unitExponent, bool apart) {
    assert(!begun_);
    makeRoom(unitExponent);
    begun_ = Begun{true, apart && !targetIsEmpty(), records_};
    if (!begun_->apart) return target();
    if (!apart_) apart_.emplace(context_, "generation apart", coefficients_ * sizeof(std::int64_t), Memory::device);
    clear(*apart_);
    return *apart_;
}

/// In a ring the oldest generation gives way to an empty one.
void CoefficientSums::beginDark() {
    if (keepRing_) makeRoom(0);
    begun_ = Begun{false, false, records_};
}

void CoefficientSums::keep() {
    assert(begun_);
    if (begun_->apart) {
        saturated_.mapped<std::uint32_t>()[0] = 0;
        commands_.begin();
        commands_.pass("accumulate");
        recordAdd(*apart_, target(), 0);
        run();
    }
    if (begun_->lit) {
        if (split_) ++(nextIsOdd() ? splitCounts_.odd : splitCounts_.even);
        ++unsettledGenerations_;
    }
    begun_.reset();
    ++kept_;
    if (keepRing_) settleAll();
}

void CoefficientSums::drop() {
    if (!begun_) return;
    records_ = begun_->recordsBefore;
    if (begun_->lit && !begun_->apart && targetIsEmpty()) clear(target());
    if (unsettledGenerations_ == 0) unsettled_.reset();
    begun_.reset();
}

/// Adds `from`, times 2^shift, to `to`, and where there is a ring to its newest slot.
void CoefficientSums::recordAdd(const Buffer& from, const Buffer& to, int shift) {
    // Without a ring the slot is not read or written; another buffer stands in its place.
    const Buffer& oldest = keepRing_ ? slots_[static_cast<std::size_t>(kept_ - 1) % slots_.size()] : saturated_;
    commands_.dispatch(program_, {{"Generation", from}, {"Slot", oldest}, {"Sum", to}, {"Saturated", saturated_}},
                       shared::AccumulatePush{coefficients_, shift, keepRing_ ? 1U : 0U},
                       linearGroups(coefficients_, 64));
}

/// Runs what is recorded and counts what met the limit.
void CoefficientSums::run() {
    commands_.submit();
    commands_.wait();
    log_.add(commands_);
    saturatedCount_ += saturated_.mapped<std::uint32_t>()[0];
}

const Buffer& CoefficientSums::startedSum() {
    if (sum_) return *sum_;
    sum_.emplace(context_, "ring sum", coefficients_ * sizeof(std::int64_t), Memory::device);
    clear(*sum_);
    return *sum_;
}

/// Watts that one count of what is unsettled stands for.
double CoefficientSums::unsettledUnit() const {
    assert(unsettled_);
    return std::ldexp(1.0 / static_cast<double>(shared::COEFFICIENT_SCALE), *unsettled_);
}

/// Whether `generation_` is what the sum would become, bit by bit.
bool CoefficientSums::isAllUnsettled() const {
    return unsettled_ && !sum_ && !split_ && !waitsForRing() && shiftOf(*unsettled_) >= 0;
}

void CoefficientSums::settle() {
    if (!isAllUnsettled() && !waitsForRing()) settleAll();
}

void CoefficientSums::settleAll() {
    if (!unsettled_) return;
    apart_.reset();  // its memory is the sum's
    const Buffer& total = startedSum();
    saturated_.mapped<std::uint32_t>()[0] = 0;
    const int shift = shiftOf(*unsettled_);
    commands_.begin();
    commands_.pass("accumulate");
    if (split_) {
        // joined before the sum rounds them: the same bits as if they had never been apart
        recordAdd(oddGeneration_, generation_, 0);
        commands_.barrier("even and odd joined");
    }
    recordAdd(generation_, total, shift);
    run();
    unsettled_.reset();
    unsettledGenerations_ = 0;
    splitCounts_ = {};
}

Light CoefficientSums::all() {
    if (isAllUnsettled()) return {&generation_, unsettledUnit()};
    return {&startedSum(), std::ldexp(1.0, baseExponent_)};
}

Light CoefficientSums::half(bool even) const {
    const int count = even ? splitCounts_.even : splitCounts_.odd;
    return {even ? &generation_ : &oddGeneration_, unsettledUnit() / count};
}

}  // namespace lumulus::photon
