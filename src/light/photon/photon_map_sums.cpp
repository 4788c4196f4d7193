// What a photon map takes from another one or a file, and gives away.
#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "gpu/transfer.h"
#include "light/photon/photon_map_state.h"
#include "light/photon/traced_sums.h"

namespace lumulus::photon {

void PhotonMap::goOnFrom(PhotonMap& other, std::span<const std::optional<std::size_t>> before) {
    State& s = *state_;
    State& old = *other.state_;
    if (s.options.ground) return;
    const MapPlan plan{s.parts, s.axisBase, s.options.bands}, was{old.parts, old.axisBase, old.options.bands};
    s.sums.goOnFrom(old.sums, keptCounts(was, plan, before));
    s.ringExtinctions = keptExtinctions(was, old.ringExtinctions, plan, before);
    s.newest = old.newest;
    s.counters = old.counters;
    if (s.walk && !s.places.empty()) s.placeCollectors();
}

std::uint32_t PhotonMap::countsOfAll() const {
    return static_cast<std::uint32_t>(state_->sums.coefficients());
}

TracedSums PhotonMap::tracedSums() {
    State& s = *state_;
    const auto generations = static_cast<std::uint64_t>(generationsInRing());
    assert(s.ringExtinctions.size() == generations);
    TracedSums sums;
    sums.photonsEach = s.options.photonsPerGeneration;
    if (generations > 0) sums.generations = {{firstInRing(), generations}};
    if (s.sums.hasUnit()) sums.unitExponent = s.sums.baseExponent();
    sums.flux = s.newest.flux;
    sums.sunDirection = s.newest.sunDirection;
    sums.counters = counters();
    sums.counts = downloadSum();
    return sums;
}

void PhotonMap::goOnFrom(const TracedSums& sums) {
    State& s = *state_;
    assert(!s.options.keepRing && s.sums.kept() == 0);
    if (sums.counts.size() != s.sums.coefficients() || sums.photonsEach != s.options.photonsPerGeneration)
        throw InputError("the photon map is of another scene", "--map-in", "give maps of this scene");
    const std::uint64_t generations = sums.generationsTraced();
    s.sums.goOnFrom(sums.counts, static_cast<int>(generations), sums.unitExponent, sums.counters.saturated);
    s.newest = {sums.flux, sums.sunDirection};
    s.counters = sums.counters;
    for (std::uint64_t i = 0; i < generations; ++i) s.ringExtinctions.emplace_back(s.parts.size(), 1.0);
    if (s.walk && !s.places.empty()) s.placeCollectors();
}

void PhotonMap::goOnFrom(std::span<const std::int64_t> counts, const TracedSums& like, int unitExponent,
                         std::span<const double> extinctions) {
    State& s = *state_;
    const GenerationRange ring = like.generations.back();
    const auto generations = static_cast<int>(ring.count);
    s.sums.goOnFromRing(counts, generations, static_cast<int>(ring.end() - s.options.firstGeneration), unitExponent);
    s.ringExtinctions.assign(static_cast<std::size_t>(generations), {extinctions.begin(), extinctions.end()});
    s.newest = {like.flux, like.sunDirection};
    if (s.walk && !s.places.empty()) s.placeCollectors();
}

void PhotonMap::add(std::span<const std::int64_t> counts, int generations, int unitExponent) {
    State& s = *state_;
    s.sums.add(counts, generations, unitExponent);
    for (int i = 0; i < generations; ++i) s.ringExtinctions.emplace_back(s.parts.size(), 1.0);
}

MapPlan PhotonMap::plan() const {
    return {state_->parts, state_->axisBase, state_->options.bands};
}

std::vector<std::int64_t> PhotonMap::downloadSum() {
    State& s = *state_;
    // a ring does not count what is traced now
    s.options.keepRing ? s.sums.settle() : s.sums.settleAll();
    auto values = gpu::download<std::int64_t>(s.context, s.sums.startedSum());
    values.resize(s.sums.coefficients());
    return values;
}

std::vector<std::int64_t> PhotonMap::downloadSlot(int slot) const {
    auto values = gpu::download<std::int64_t>(state_->context, state_->sums.slots().at(static_cast<std::size_t>(slot)));
    values.resize(state_->sums.coefficients());
    return values;
}

}  // namespace lumulus::photon
