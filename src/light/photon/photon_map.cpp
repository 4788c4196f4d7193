#include "light/photon/photon_map.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>

#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "light/photon/emission.h"
#include "light/photon/generation.h"
#include "light/photon/map_limits.h"
#include "shared/collision_estimator.h"
#include "shared/photon.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/accumulate.comp.h"
#include "spirv/photon/reconstruct.comp.h"
}  // namespace spirv

using gpu::Buffer;
using gpu::linearGroups;
using gpu::Memory;
using gpu::Program;
using gpu::SpecConstant;

/// The ring counts in 2⁻⁴² of the greatest flux that the first generation's lights may have: 2⁻²⁵ of a photon's power
/// at 1e5 photons, and 2¹⁹ times the flux before saturation.
constexpr int unitBits = 42;
/// Of a record's 20 bits of power, given up where the ring then takes a generation of many photons as it is: without a
/// ring generations then add up in one buffer, instead of a pass over all of it after each.
constexpr int sparedBits = 4;
/// Records that generations may leave together before the sum takes them: half of what requireCountable() allows.
constexpr std::uint64_t settleBeyond = 1ULL << 37U;

int exponentAbove(double value) {
    return static_cast<int>(std::ceil(std::log2(value)));
}

double maxChannel(const glm::dvec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// Through the cloud's box, wherever the sun stands: so the ring's unit does not depend on it, and pictures under a sun
/// that came there have the bits of those where it always was.
double greatestFlux(const scene::Sun& sun, const Emission& emission, const glm::dmat3& faceArea) {
    const double area = glm::length(faceArea[0]) + glm::length(faceArea[1]) + glm::length(faceArea[2]);
    return maxChannel(sun.irradiance * area + emission.skyFlux);
}

/// A texel for each collector.
gpu::Image collectorImage(gpu::Context& context, const char* name, std::uint32_t collectors) {
    const glm::ivec2 extent(shared::COLLECTORS_WIDTH, collectors / shared::COLLECTORS_WIDTH + 1);
    return {context, name, extent, VK_FORMAT_R32G32B32A32_SFLOAT};
}

/// Of all collectors together, where there is room for them.
std::uint32_t coefficientsOf(const gpu::Context& context, std::uint32_t collectors, const Options& options) {
    const MapSize size{collectors,
                       options.bands,
                       options.generations,
                       options.keepRing,
                       options.splitGenerations,
                       shared::estimatorCounts(options.estimates.cells)};
    requireMapFits(size, options.memoryBudget, context.limits().maxStorageBufferRange);
    return static_cast<std::uint32_t>(generationBytes(size) / sizeof(std::int64_t));
}

}  // namespace

struct PhotonMap::State {
    State(gpu::Context& gpuContext, const cloud::Asset& preparedCloud, const Medium& theMedium,
          const Options& theOptions);

    gpu::Context& context;
    const cloud::Asset& cloud;
    const Medium medium;
    Options options;
    std::uint32_t collectors;
    std::uint32_t coefficients;  // of all collectors

    GenerationTracer tracer;
    Program<shared::AccumulatePush> accumulateProgram;
    Program<shared::ReconstructPush> reconstructProgram;

    Buffer moments, places, generation, oddGeneration, saturated;
    std::optional<Buffer> sum;  // from when there is something to add together
    gpu::Image fluences, radiance;
    std::vector<Buffer> slots;
    gpu::Commands commands;

    int traced = 0;        // generations so far
    int baseExponent = 0;  // of the ring's unit [W]; set by the first generation that has light
    bool hasUnit = false;
    std::optional<int> unsettled;  // unit exponent of what `generation` holds and the sum does not
    std::uint64_t unsettledRecords = 0;
    double flux = 0.0;        // luminance of the newest generation's light [W]
    SplitCounts splitCounts;  // of what is unsettled
    Counters counters;
    PassLog log;
    std::deque<double> ringExtinctions;  // of the generations in the ring, over the medium's

    /// From a generation's unit to the ring's.
    int shiftOf(int unitExponent) const {
        return unitExponent - std::countr_zero(static_cast<unsigned>(shared::COEFFICIENT_SCALE)) - baseExponent;
    }
    void makeRoom(int unitExponent);
    void settle();
    const Buffer& startedSum();
    bool isAllUnsettled() const;
    const Buffer& target();
    double unsettledUnit() const;
    void recordAdd(const Buffer& from, const Buffer& to, int shift);
};

PhotonMap::State::State(gpu::Context& gpuContext, const cloud::Asset& preparedCloud, const Medium& theMedium,
                        const Options& theOptions)
    : context(gpuContext),
      cloud(preparedCloud),
      medium(theMedium),
      options(theOptions),
      collectors(static_cast<std::uint32_t>(cloud.collectors.size())),
      coefficients(coefficientsOf(context, collectors, options)),
      tracer(context, cloud, medium, options),
      accumulateProgram(context, "accumulate", spirv::accumulate_comp),
      reconstructProgram(context, "reconstruct", spirv::reconstruct_comp, {SpecConstant::of(0, options.bands)}),
      moments(context, "band moments", medium.tables.bandMoments.size() * sizeof(float), Memory::device),
      places(context, "collector places", collectors * sizeof(glm::vec4), Memory::device),
      generation(context, "generation", coefficients * sizeof(std::int64_t), Memory::device),
      oddGeneration(context, "odd generation", options.splitGenerations ? coefficients * sizeof(std::int64_t) : 0,
                    Memory::device),
      saturated(context, "saturated", sizeof(std::uint32_t), Memory::host),
      fluences(collectorImage(context, "collector fluences", collectors)),
      radiance(collectorImage(context, "collector radiance", collectors)),
      commands(context) {
    if (options.keepRing)
        for (int i = 0; i < options.generations; ++i)
            slots.emplace_back(context, "ring slot " + std::to_string(i), coefficients * sizeof(std::int64_t),
                               Memory::device);
    gpu::upload(context, moments, medium.tables.bandMoments);
}

/// Clears the generation's buffer, where it does not hold light in the same unit that the sum can take later, with room
/// for more. A ring has to know its generations one by one; where they are rounded into it, so does a sum that is to
/// have the same bits.
void PhotonMap::State::makeRoom(int unitExponent) {
    const bool exact = shiftOf(unitExponent) >= 0 || options.splitGenerations;
    if (unsettled == unitExponent && exact && !options.keepRing && unsettledRecords <= settleBeyond) return;
    settle();
    commands.begin();
    commands.fill(generation, 0);
    if (options.splitGenerations) commands.fill(oddGeneration, 0);
    commands.submit();
    commands.wait();
    unsettled = unitExponent;
    unsettledRecords = 0;
}

/// Where the next generation adds its light.
const Buffer& PhotonMap::State::target() {
    if (!options.splitGenerations) return generation;
    const bool odd = traced % 2 == 1;
    ++(odd ? splitCounts.odd : splitCounts.even);
    return odd ? oddGeneration : generation;
}

/// Watts that one count of what is unsettled stands for.
double PhotonMap::State::unsettledUnit() const {
    assert(unsettled);
    return std::ldexp(1.0 / static_cast<double>(shared::COEFFICIENT_SCALE), *unsettled);
}

/// Adds `from`, times 2^shift, to `to`, and where there is a ring to its newest slot.
void PhotonMap::State::recordAdd(const Buffer& from, const Buffer& to, int shift) {
    const std::size_t slot = static_cast<std::size_t>((traced - 1) % options.generations);
    // Without a ring the slot is not read or written; another buffer stands in its place.
    const Buffer& oldest = options.keepRing ? slots[slot] : places;
    commands.dispatch(
        accumulateProgram, {{"Generation", from}, {"Slot", oldest}, {"Sum", to}, {"Saturated", saturated}},
        shared::AccumulatePush{coefficients, shift, options.keepRing ? 1U : 0U}, linearGroups(coefficients, 64));
}

/// The sum, empty at first.
const Buffer& PhotonMap::State::startedSum() {
    if (sum) return *sum;
    sum.emplace(context, "ring sum", coefficients * sizeof(std::int64_t), Memory::device);
    commands.begin();
    commands.fill(*sum, 0);
    commands.submit();
    commands.wait();
    return *sum;
}

/// Whether `generation` is what the sum would become, bit by bit.
bool PhotonMap::State::isAllUnsettled() const {
    return unsettled && !sum && !options.splitGenerations && shiftOf(*unsettled) >= 0;
}

/// Adds what was traced to the sum.
void PhotonMap::State::settle() {
    if (!unsettled) return;
    const Buffer& total = startedSum();
    saturated.mapped<std::uint32_t>()[0] = 0;
    const int shift = shiftOf(*unsettled);
    commands.begin();
    commands.pass("accumulate");
    if (options.splitGenerations) {
        // joined before the sum rounds them: the same bits as if they had never been apart
        recordAdd(oddGeneration, generation, 0);
        commands.barrier("even and odd joined");
    }
    recordAdd(generation, total, shift);
    commands.submit();
    commands.wait();
    log.add(commands);
    counters.saturated += saturated.mapped<std::uint32_t>()[0];
    unsettled.reset();
    splitCounts = {};
}

PhotonMap::PhotonMap(gpu::Context& context, const cloud::Asset& cloud, const Medium& medium, const Options& options)
    : state_(std::make_unique<State>(context, cloud, medium, options)) {
    State& s = *state_;
    const std::vector<double> mass = masses();
    std::vector<glm::vec4> places;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i)
        places.emplace_back(cloud.collectors[i].centre, static_cast<float>(mass[i]));
    gpu::upload(context, s.places, places);
    if (s.slots.empty()) return;
    s.commands.begin();
    for (Buffer& slot : s.slots) s.commands.fill(slot, 0);
    s.commands.submit();
    s.commands.wait();
}

PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap::~PhotonMap() = default;

void PhotonMap::trace(const scene::Sun& sun, const sky::Environment& environment, std::optional<double> extinctionNow) {
    State& s = *state_;
    const double extinction = extinctionNow.value_or(s.medium.extinction);
    const Emission emission = makeEmission(sun, environment, s.tracer.faceArea());
    int unitExponent = 0;
    s.flux = luminance(emission.sunFlux + emission.skyFlux);
    if (!emission.dark()) {
        const double most = std::max(maxChannel(emission.sunPower(s.options.photonsPerGeneration)),
                                     maxChannel(emission.skyPower(s.options.photonsPerGeneration)));
        if (!s.hasUnit) {
            s.baseExponent = exponentAbove(greatestFlux(sun, emission, s.tracer.faceArea())) - unitBits;
            s.hasUnit = true;
        }
        unitExponent = exponentAbove(most / static_cast<double>(shared::POWER_UNITS));
        const int finer = -s.shiftOf(unitExponent);
        if (finer > 0 && finer <= sparedBits) unitExponent += finer;
        s.makeRoom(unitExponent);
        s.tracer.trace(emission, sun, extinction, unitExponent, static_cast<std::uint32_t>(s.traced), s.target(),
                       s.counters, s.unsettledRecords, s.log);
    } else if (s.options.keepRing) {
        s.makeRoom(unitExponent);  // the oldest generation gives way to an empty one
    }
    ++s.traced;
    s.ringExtinctions.push_back(extinction / s.medium.extinction);
    if (s.options.keepRing && s.traced > s.options.generations) s.ringExtinctions.pop_front();
    if (s.options.keepRing) s.settle();
}

Light PhotonMap::light(Part part) {
    State& s = *state_;
    if (part == Part::all) {
        // Σ c over Σ M: equal extinctions give exactly the number of generations
        const double masses = std::accumulate(s.ringExtinctions.begin(), s.ringExtinctions.end(), 0.0);
        const double generations = masses > 0.0 ? masses : 1.0;
        settle();
        if (s.isAllUnsettled()) return {&s.generation, s.unsettledUnit() / generations};
        return {&s.startedSum(), unit() / generations};
    }
    const bool even = part == Part::even;
    return {even ? &s.generation : &s.oddGeneration,
            s.unsettledUnit() / (even ? s.splitCounts.even : s.splitCounts.odd)};
}

void PhotonMap::reconstruct(gpu::Commands& commands, const glm::vec3& eyeVoxel, const Light& light) {
    State& s = *state_;
    shared::ReconstructPush push{};
    push.collectors = s.collectors;
    push.scale = static_cast<float>(light.unit);
    push.eye = eyeVoxel;
    push.voxelToWorld = glm::mat3(s.cloud.voxelToMetres);
    commands.pass("reconstruct");
    commands.dispatch(s.reconstructProgram,
                      {{"Sum", *light.counts},
                       {"Moments", s.moments},
                       {"Collectors", s.places},
                       {"fluences", s.fluences},
                       {"radiance", s.radiance}},
                      push, linearGroups(s.collectors, 64));
}

void PhotonMap::settle() {
    if (!state_->isAllUnsettled()) state_->settle();
}

const gpu::Image& PhotonMap::radiance() const {
    return state_->radiance;
}
const gpu::Image& PhotonMap::fluences() const {
    return state_->fluences;
}
int PhotonMap::generationsInRing() const {
    return state_->options.keepRing ? std::min(state_->traced, state_->options.generations) : state_->traced;
}
SplitCounts PhotonMap::splitCounts() const {
    return state_->splitCounts;
}
std::uint32_t PhotonMap::estimatorBase() const {
    return state_->coefficients - shared::estimatorCounts(state_->options.estimates.cells);
}
double PhotonMap::photonPower() const {
    const double photons = static_cast<double>(state_->options.photonsPerGeneration) * std::max(1, generationsInRing());
    return state_->flux / photons;
}
std::uint64_t PhotonMap::firstInRing() const {
    return state_->options.firstGeneration + static_cast<std::uint64_t>(state_->traced - generationsInRing());
}
std::uint64_t PhotonMap::photonsInRing() const {
    return state_->options.photonsPerGeneration * static_cast<std::uint64_t>(generationsInRing());
}
const Counters& PhotonMap::counters() const {
    return state_->counters;
}
std::vector<gpu::PassTime> PhotonMap::times() const {
    return state_->log.times;
}
const std::vector<gpu::Step>& PhotonMap::steps() const {
    return state_->log.steps;
}
double PhotonMap::unit() const {
    return std::ldexp(1.0, state_->baseExponent);
}

std::vector<std::int64_t> PhotonMap::downloadSum() {
    state_->settle();
    auto values = gpu::download<std::int64_t>(state_->context, state_->startedSum());
    values.resize(state_->coefficients);
    return values;
}

std::vector<std::int64_t> PhotonMap::downloadSlot(int slot) const {
    auto values = gpu::download<std::int64_t>(state_->context, state_->slots.at(static_cast<std::size_t>(slot)));
    values.resize(state_->coefficients);
    return values;
}

double PhotonMap::massScale() const {
    const State& s = *state_;
    return s.medium.extinction * (1.0 - static_cast<double>(s.medium.tables.forwardFraction)) * s.cloud.voxelVolume;
}

std::vector<double> PhotonMap::masses() const {
    std::vector<double> result;
    for (const cloud::Collector& collector : state_->cloud.collectors)
        result.push_back(static_cast<double>(collector.mass) * massScale());
    return result;
}

}  // namespace lumulus::photon
