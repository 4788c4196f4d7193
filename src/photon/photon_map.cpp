#include "photon/photon_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/interrupt.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "photon/emission.h"
#include "photon/map_limits.h"
#include "photon/trace_program.h"
#include "shared/photon.h"
#include "shared/rng.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/accumulate.comp.h"
#include "spirv/photon/gather.comp.h"
#include "spirv/photon/reconstruct.comp.h"
#include "spirv/photon/scan.comp.h"
#include "spirv/photon/scatter.comp.h"
}  // namespace spirv

using gpu::Buffer;
using gpu::linearGroups;
using gpu::Memory;
using gpu::Program;
using gpu::Sampler;
using gpu::SpecConstant;

/// Records that one round of tracing can hold; what does not fit waits for the next round.
constexpr std::uint32_t roundRecords = 1U << 21U;
/// Enough lanes to fill the device, few enough that each walks dozens of photons.
constexpr std::uint32_t cpuInvocations = 2048, gpuInvocations = 65536;
/// Rows of workgroups that share the records of the invocations.
constexpr std::uint32_t sortRows = 16;
constexpr std::uint32_t stepLimit = 1U << 15U;
/// A photon that collides more often is counted as lost. Optical depth 1e6 with albedo 1 stays below it.
constexpr std::uint32_t collisionLimit = 1U << 24U;
/// The ring counts in 2⁻⁴² of the first generation's flux: 2⁻²⁵ of a photon's power at 1e5 photons, and 2¹⁹ times the
/// flux before saturation.
constexpr int unitBits = 42;

int exponentAbove(double value) {
    return static_cast<int>(std::ceil(std::log2(value)));
}

double maxChannel(const glm::dvec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

std::uint32_t invocationsFor(const gpu::Context& context, std::uint64_t photons) {
    const std::uint64_t most = context.isCpu() ? cpuInvocations : gpuInvocations;
    return static_cast<std::uint32_t>(std::min(most, (photons + 63) / 64 * 64));
}

/// Records of one invocation: as many as a round holds, fewer where few photons cannot fill them, since the sort looks
/// at every place.
std::uint32_t capacityFor(std::uint64_t photons, std::uint32_t invocations) {
    const std::uint64_t wanted = std::max<std::uint64_t>(64, 64 * photons / invocations);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, roundRecords / invocations));
}

/// Of all collectors together, where there is room for them.
std::uint32_t coefficientsOf(const gpu::Context& context, std::uint32_t collectors, const Options& options) {
    const MapSize size{collectors, options.bands, options.generations, options.keepRing};
    requireMapFits(size, options.memoryBudget, context.limits().maxStorageBufferRange);
    return static_cast<std::uint32_t>(generationBytes(size) / sizeof(std::int64_t));
}

}  // namespace

struct PhotonMap::State {
    State(gpu::Context& gpuContext, const cloud::Cloud& preparedCloud, const Medium& theMedium,
          const Options& theOptions);

    gpu::Context& context;
    const cloud::Cloud& cloud;
    Medium medium;
    Options options;
    std::uint32_t collectors;
    std::uint32_t coefficients;  // of all collectors
    std::uint32_t invocations;
    std::uint32_t recordCapacity;
    glm::dmat3 faceArea;

    Program<gpu::NoPush> traceProgram;
    Program<shared::GatherPush> scanProgram, scatterProgram, gatherProgram;
    Program<shared::AccumulatePush> accumulateProgram;
    Program<shared::ReconstructPush> reconstructProgram;

    Buffer params, states, records, recordCounts, collectorCounts, counterBuffer;
    Buffer cursors, chunkOffsets, gatherArguments, sorted;
    Buffer inverseCdf, moments, places, generation, sum, saturated, radiance;
    std::vector<Buffer> slots;
    gpu::Commands commands;

    int traced = 0;        // generations so far
    int baseExponent = 0;  // of the ring's unit [W]; set by the first generation that has light
    bool hasUnit = false;
    std::optional<int> unsettled;  // unit exponent of what `generation` holds and the sum does not
    Counters counters;
    std::vector<gpu::PassTime> times;
    std::vector<gpu::Step> steps;

    shared::TraceParams traceParams(const Emission& emission, const scene::Sun& sun, int unitExponent) const;
    void traceRound();
    void makeRoom(int unitExponent);
    void settle();
    void addTimes();
};

PhotonMap::State::State(gpu::Context& gpuContext, const cloud::Cloud& preparedCloud, const Medium& theMedium,
                        const Options& theOptions)
    : context(gpuContext),
      cloud(preparedCloud),
      medium(theMedium),
      options(theOptions),
      collectors(static_cast<std::uint32_t>(cloud.collectors.size())),
      coefficients(coefficientsOf(context, collectors, options)),
      invocations(invocationsFor(context, options.photonsPerGeneration)),
      recordCapacity(capacityFor(options.photonsPerGeneration, invocations)),
      faceArea(faceAreas(cloud.toWorld.linear, glm::dvec3(cloud.size))),
      traceProgram(context, "trace", traceSpirv(), traceConstants(medium.tables, medium.albedo, false)),
      scanProgram(context, "scan", spirv::scan_comp),
      scatterProgram(context, "scatter", spirv::scatter_comp),
      gatherProgram(context, "gather", spirv::gather_comp, {SpecConstant::of(0, options.bands)}),
      accumulateProgram(context, "accumulate", spirv::accumulate_comp),
      reconstructProgram(context, "reconstruct", spirv::reconstruct_comp, {SpecConstant::of(0, options.bands)}),
      params(context, "trace params", sizeof(shared::TraceParams), Memory::host),
      states(context, "trace states", invocations * sizeof(shared::TraceState), Memory::host),
      records(context, "records", std::uint64_t{invocations} * recordCapacity * sizeof(shared::PhotonRecord),
              Memory::device),
      recordCounts(context, "record counts", invocations * sizeof(std::uint32_t), Memory::device),
      collectorCounts(context, "collector counts", collectors * sizeof(std::uint32_t), Memory::device),
      counterBuffer(context, "trace counters", sizeof(shared::TraceCounters), Memory::host),
      cursors(context, "cursors", collectors * sizeof(std::uint32_t), Memory::device),
      chunkOffsets(context, "chunk offsets", (collectors + 1) * sizeof(std::uint32_t), Memory::device),
      gatherArguments(context, "gather arguments", sizeof(glm::uvec3), Memory::device),
      sorted(context, "sorted records", std::uint64_t{invocations} * recordCapacity * sizeof(glm::uvec3),
             Memory::device),
      inverseCdf(context, "inverse cdf", medium.tables.inverseCdf.size() * sizeof(float), Memory::device),
      moments(context, "band moments", medium.tables.bandMoments.size() * sizeof(float), Memory::device),
      places(context, "collector places", collectors * sizeof(glm::vec4), Memory::device),
      generation(context, "generation", coefficients * sizeof(std::int64_t), Memory::device),
      sum(context, "ring sum", coefficients * sizeof(std::int64_t), Memory::device),
      saturated(context, "saturated", sizeof(std::uint32_t), Memory::host),
      radiance(context, "collector radiance", collectors * sizeof(glm::vec3), Memory::device),
      commands(context) {
    if (options.keepRing)
        for (int i = 0; i < options.generations; ++i)
            slots.emplace_back(context, "ring slot " + std::to_string(i), coefficients * sizeof(std::int64_t),
                               Memory::device);
    if (!medium.tables.inverseCdf.empty()) gpu::upload(context, inverseCdf, medium.tables.inverseCdf);
    gpu::upload(context, moments, medium.tables.bandMoments);
}

shared::TraceParams PhotonMap::State::traceParams(const Emission& emission, const scene::Sun& sun,
                                                  int unitExponent) const {
    shared::TraceParams p{};
    const double f = static_cast<double>(medium.tables.forwardFraction);
    const double least = std::min(medium.albedo.x, std::min(medium.albedo.y, medium.albedo.z));
    p.worldToVoxel = glm::mat3(glm::inverse(cloud.toWorld.linear));
    p.size = glm::vec3(cloud.size);
    p.cells = cloud.majorants.cells;
    p.cellSize = cloud.majorants.cellSize;
    p.extinction = static_cast<float>(medium.extinction * (1.0 - f * least));
    p.turnShare = static_cast<float>((1.0 - f) / (1.0 - f * least));
    p.albedo = glm::vec3(medium.albedo);
    p.straightWeight = least < 1.0 ? glm::vec3((medium.albedo - least) / (1.0 - least)) : glm::vec3(0.0F);
    p.turnFraction = static_cast<float>(1.0 - f);
    p.asymmetry = medium.tables.g;
    p.sunDirection = glm::vec3(-sun.directionTo);
    p.sunCone = static_cast<float>(2.0 * std::pow(std::sin(0.25 * glm::radians(sun.angularDiameter)), 2));
    for (int axis = 0; axis < 3; ++axis) p.faceArea[axis] = glm::vec3(faceArea[axis]);
    const double watts = std::ldexp(1.0, -unitExponent);
    p.sunPower = glm::vec3(emission.sunPower(options.photonsPerGeneration) * watts);
    p.skyPower = glm::vec3(emission.skyPower(options.photonsPerGeneration) * watts);
    p.photons = static_cast<std::uint32_t>(options.photonsPerGeneration);
    p.generation = options.firstGeneration + static_cast<std::uint32_t>(traced);
    p.stream = shared::rngStream(static_cast<std::uint32_t>(options.seed),
                                 static_cast<std::uint32_t>(options.seed >> 32U), 0U);
    const glm::uvec4 bits = shared::pcg4d({p.generation, 0xE117U, 0U, p.stream});
    p.sunPhotons = static_cast<std::uint32_t>(
        emission.sunPhotons(options.photonsPerGeneration, static_cast<double>(bits.x) * 0x1p-32));
    p.collectors = collectors;
    p.invocations = invocations;
    p.recordCapacity = recordCapacity;
    p.stepLimit = stepLimit;
    p.collisionLimit = collisionLimit;
    return p;
}

void PhotonMap::State::traceRound() {
    counterBuffer.mapped<shared::TraceCounters>()[0] = {};
    const shared::GatherPush push{collectors, invocations, recordCapacity};
    commands.begin();
    commands.pass("trace");
    commands.fill(collectorCounts, 0);
    commands.barrier("counts cleared");
    commands.dispatch(traceProgram,
                      {{"density", cloud.density, Sampler::linear},
                       {"collectorIndex", cloud.collectorIndex, Sampler::nearest},
                       {"Params", params},
                       {"majorants", cloud.majorantImage, Sampler::nearest},
                       {"InverseCdf", inverseCdf},
                       {"States", states},
                       {"Records", records},
                       {"RecordCounts", recordCounts},
                       {"CollectorCounts", collectorCounts},
                       {"Counters", counterBuffer}},
                      {}, linearGroups(invocations, 64));
    commands.barrier("records");
    commands.pass("sort");
    commands.dispatch(scanProgram,
                      {{"CollectorCounts", collectorCounts},
                       {"Cursors", cursors},
                       {"ChunkOffsets", chunkOffsets},
                       {"GatherArguments", gatherArguments}},
                      push, {1, 1, 1});
    commands.barrier("offsets");
    commands.dispatch(scatterProgram,
                      {{"Records", records}, {"RecordCounts", recordCounts}, {"Cursors", cursors}, {"Sorted", sorted}},
                      push, {invocations / 64, std::min(recordCapacity, sortRows), 1});
    commands.barrier("sorted records");
    commands.pass("gather");
    commands.dispatchIndirect(gatherProgram,
                              {{"ChunkOffsets", chunkOffsets},
                               {"Cursors", cursors},
                               {"CollectorCounts", collectorCounts},
                               {"Sorted", sorted},
                               {"Coefficients", generation}},
                              push, gatherArguments);
    commands.submit();
    commands.wait();
    addTimes();
}

/// Clears the generation's buffer, where it does not hold light in the same unit that the sum can take later. A ring
/// has to know its generations one by one.
void PhotonMap::State::makeRoom(int unitExponent) {
    if (unsettled == unitExponent && !options.keepRing) return;
    settle();
    commands.begin();
    commands.fill(generation, 0);
    commands.submit();
    commands.wait();
    unsettled = unitExponent;
}

/// Adds what was traced to the sum.
void PhotonMap::State::settle() {
    if (!unsettled) return;
    saturated.mapped<std::uint32_t>()[0] = 0;
    const std::size_t slot = static_cast<std::size_t>((traced - 1) % options.generations);
    // Without a ring the slot is not read or written; another buffer stands in its place.
    const Buffer& oldest = options.keepRing ? slots[slot] : radiance;
    const int shift = *unsettled - std::countr_zero(static_cast<unsigned>(shared::COEFFICIENT_SCALE)) - baseExponent;
    commands.begin();
    commands.pass("accumulate");
    commands.dispatch(
        accumulateProgram, {{"Generation", generation}, {"Slot", oldest}, {"Sum", sum}, {"Saturated", saturated}},
        shared::AccumulatePush{coefficients, shift, options.keepRing ? 1U : 0U}, linearGroups(coefficients, 64));
    commands.submit();
    commands.wait();
    addTimes();
    counters.saturated += saturated.mapped<std::uint32_t>()[0];
    unsettled.reset();
}

void PhotonMap::State::addTimes() {
    steps = commands.steps();
    for (const gpu::PassTime& pass : commands.times()) {
        const auto known =
            std::find_if(times.begin(), times.end(), [&](const gpu::PassTime& t) { return t.name == pass.name; });
        if (known == times.end())
            times.push_back(pass);
        else
            known->milliseconds += pass.milliseconds;
    }
}

PhotonMap::PhotonMap(gpu::Context& context, const cloud::Cloud& cloud, const Medium& medium, const Options& options)
    : state_(std::make_unique<State>(context, cloud, medium, options)) {
    State& s = *state_;
    const std::vector<double> mass = masses();
    std::vector<glm::vec4> places;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i)
        places.emplace_back(cloud.collectors[i].centre, static_cast<float>(mass[i]));
    gpu::upload(context, s.places, places);
    s.commands.begin();
    s.commands.fill(s.sum, 0);
    for (Buffer& slot : s.slots) s.commands.fill(slot, 0);
    s.commands.submit();
    s.commands.wait();
}

PhotonMap::~PhotonMap() = default;

void PhotonMap::trace(const scene::Sun& sun, const scene::Sky& sky) {
    State& s = *state_;
    const Emission emission = makeEmission(sun, sky, s.faceArea);
    int unitExponent = 0;
    if (!emission.dark()) {
        const double most = std::max(maxChannel(emission.sunPower(s.options.photonsPerGeneration)),
                                     maxChannel(emission.skyPower(s.options.photonsPerGeneration)));
        unitExponent = exponentAbove(most / static_cast<double>(shared::POWER_UNITS));
        if (!s.hasUnit) {
            s.baseExponent = exponentAbove(maxChannel(emission.sunFlux + emission.skyFlux)) - unitBits;
            s.hasUnit = true;
        }
        s.makeRoom(unitExponent);
        s.params.mapped<shared::TraceParams>()[0] = s.traceParams(emission, sun, unitExponent);
        resetStates(s.states.mapped<shared::TraceState>().subspan(0, s.invocations));
        const std::uint64_t recordsBefore = s.counters.records;
        do {
            stopIfInterrupted();
            s.traceRound();
            const shared::TraceCounters& c = s.counterBuffer.mapped<shared::TraceCounters>()[0];
            s.counters.events += c.events;
            s.counters.nulls += c.nulls;
            s.counters.absorbed += c.absorbed;
            s.counters.escaped += c.escaped;
            s.counters.lost += c.lost;
            s.counters.records += c.records;
            requireCountable(s.counters.records - recordsBefore);
        } while (s.counterBuffer.mapped<shared::TraceCounters>()[0].pending > 0);
        s.counters.emitted += s.options.photonsPerGeneration;
    } else if (s.options.keepRing) {
        s.makeRoom(unitExponent);  // the oldest generation gives way to an empty one
    }
    ++s.traced;
    if (s.options.keepRing) s.settle();
}

void PhotonMap::reconstruct(gpu::Commands& commands, const glm::vec3& eyeVoxel) {
    State& s = *state_;
    s.settle();
    shared::ReconstructPush push{};
    push.collectors = s.collectors;
    push.scale = static_cast<float>(unit() / std::max(1, generationsInRing()));
    push.eye = eyeVoxel;
    push.voxelToWorld = glm::mat3(s.cloud.toWorld.linear);
    commands.pass("reconstruct");
    commands.dispatch(s.reconstructProgram,
                      {{"Sum", s.sum}, {"Moments", s.moments}, {"Collectors", s.places}, {"Radiance", s.radiance}},
                      push, linearGroups(s.collectors, 64));
}

void PhotonMap::settle() {
    state_->settle();
}

const gpu::Buffer& PhotonMap::radiance() const {
    return state_->radiance;
}
int PhotonMap::generationsInRing() const {
    return std::min(state_->traced, state_->options.generations);
}
const Counters& PhotonMap::counters() const {
    return state_->counters;
}
std::vector<gpu::PassTime> PhotonMap::times() const {
    return state_->times;
}
const std::vector<gpu::Step>& PhotonMap::steps() const {
    return state_->steps;
}
double PhotonMap::unit() const {
    return std::ldexp(1.0, state_->baseExponent);
}

std::vector<std::int64_t> PhotonMap::downloadSum() {
    state_->settle();
    auto values = gpu::download<std::int64_t>(state_->context, state_->sum);
    values.resize(state_->coefficients);
    return values;
}

std::vector<std::int64_t> PhotonMap::downloadSlot(int slot) const {
    auto values = gpu::download<std::int64_t>(state_->context, state_->slots.at(static_cast<std::size_t>(slot)));
    values.resize(state_->coefficients);
    return values;
}

std::vector<double> PhotonMap::masses() const {
    const State& s = *state_;
    const double factor =
        s.medium.extinction * (1.0 - static_cast<double>(s.medium.tables.forwardFraction)) * s.cloud.voxelVolume;
    std::vector<double> result;
    for (const cloud::Collector& collector : s.cloud.collectors)
        result.push_back(static_cast<double>(collector.mass) * factor);
    return result;
}

}  // namespace lumulus::photon
