#include "light/photon/generation.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/stopwatch.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "light/photon/map_limits.h"
#include "light/photon/trace_program.h"
#include "shared/collision_estimator.h"
#include "shared/rng.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/gather.comp.h"
#include "spirv/photon/scan.comp.h"
#include "spirv/photon/scatter.comp.h"
}  // namespace spirv

using gpu::linearGroups;
using gpu::Memory;
using gpu::Sampler;
using gpu::SpecConstant;

/// Records that one round of tracing can hold; what does not fit waits for the next round.
constexpr std::uint32_t roundRecords = 1U << 21U;
/// Enough lanes to fill the device, few enough that each walks dozens of photons: those that finish early idle until
/// the last one of their group does.
constexpr std::uint32_t coreInvocations = 512, gpuInvocations = 65536;
constexpr unsigned leastCores = 2, mostCores = 16;
/// Rows of workgroups that share the records of the invocations.
constexpr std::uint32_t sortRows = 16;
/// Steps of an invocation in one round: a round ends within tenths of a second, so that work can end between two.
constexpr std::uint32_t stepLimit = 1U << 13U;
/// Seconds after which the next rounds of a generation get fewer steps.
constexpr double longRound = 0.08;
/// A photon that collides more often is counted as lost. Optical depth 1e6 with albedo 1 stays below it.
constexpr std::uint32_t collisionLimit = 1U << 24U;

std::uint32_t invocationsFor(const gpu::Context& context, std::uint64_t photons) {
    const unsigned cores = std::clamp(std::thread::hardware_concurrency(), leastCores, mostCores);
    const std::uint64_t most = context.isCpu() ? coreInvocations * cores : gpuInvocations;
    return static_cast<std::uint32_t>(std::min(most, (photons + 63) / 64 * 64));
}

/// Records of one invocation: as many as a round holds, fewer where few photons cannot fill them.
std::uint32_t capacityFor(std::uint64_t photons, std::uint32_t invocations) {
    const std::uint64_t wanted = std::max<std::uint64_t>(64, 64 * photons / invocations);
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, roundRecords / invocations));
}

}  // namespace

void PassLog::add(const gpu::Commands& commands) {
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

GenerationTracer::GenerationTracer(gpu::Context& context, const cloud::Asset& cloud, const Medium& medium,
                                   const Options& options)
    : cloud_(cloud),
      medium_(medium),
      options_(options),
      collectors_(static_cast<std::uint32_t>(cloud.collectors.size())),
      invocations_(invocationsFor(context, options.photonsPerGeneration)),
      recordCapacity_(capacityFor(options.photonsPerGeneration, invocations_)),
      faceArea_(faceAreas(cloud.voxelToMetres, glm::dvec3(cloud.size))),
      traceProgram_(context, "trace", traceSpirv(), traceConstants(medium.tables, medium.albedo, false, options.air)),
      scanProgram_(context, "scan", spirv::scan_comp),
      scatterProgram_(context, "scatter", spirv::scatter_comp),
      gatherProgram_(context, "gather", spirv::gather_comp, {SpecConstant::of(0, options.bands)}),
      params_(context, "trace params", sizeof(shared::TraceParams), Memory::host),
      states_(context, "trace states", invocations_ * sizeof(shared::TraceState), Memory::host),
      records_(context, "records", std::uint64_t{invocations_} * recordCapacity_ * sizeof(shared::PhotonRecord),
               Memory::device),
      recordCounts_(context, "record counts", invocations_ * sizeof(std::uint32_t), Memory::device),
      collectorCounts_(context, "collector counts", collectors_ * sizeof(std::uint32_t), Memory::device),
      counters_(context, "trace counters", sizeof(shared::TraceCounters), Memory::host),
      cursors_(context, "cursors", collectors_ * sizeof(std::uint32_t), Memory::device),
      chunkOffsets_(context, "chunk offsets", (collectors_ + 1) * sizeof(std::uint32_t), Memory::device),
      gatherArguments_(context, "gather arguments", sizeof(glm::uvec3), Memory::device),
      sorted_(context, "sorted records", std::uint64_t{invocations_} * recordCapacity_ * sizeof(glm::uvec3),
              Memory::device),
      inverseCdf_(context, "inverse cdf", medium.tables.inverseCdf.size() * sizeof(float), Memory::device),
      skyCells_(context, "sky cells", options.air ? sky::SkyMaps::cells * sizeof(shared::SkyCell) : 0, Memory::host),
      sunColours_(
          context, "sun colours",
          options.air ? std::uint64_t{shared::SUN_COLOUR_COLUMNS} * shared::SUN_COLOUR_ROWS * sizeof(glm::vec3) : 0,
          Memory::host),
      commands_(context) {
    if (!medium.tables.inverseCdf.empty()) gpu::upload(context, inverseCdf_, medium.tables.inverseCdf);
}

void GenerationTracer::setAir(const AirLight& air) {
    std::ranges::copy(air.cells, skyCells_.mapped<shared::SkyCell>().begin());
    std::ranges::copy(air.sunColours, sunColours_.mapped<glm::vec3>().begin());
    airPlace_ = air.place;
    skyAxes_ = glm::mat3(air.skyAxes);
}

shared::TraceParams GenerationTracer::traceParams(const Emission& emission, const scene::Sun& sun, double extinction,
                                                  int unitExponent, std::uint32_t number) const {
    shared::TraceParams p{};
    const double f = static_cast<double>(medium_.tables.forwardFraction);
    const double least = std::min(medium_.albedo.x, std::min(medium_.albedo.y, medium_.albedo.z));
    p.size = glm::vec3(cloud_.size);
    p.cells = cloud_.majorants.cells;
    p.cellSize = cloud_.majorants.cellSize;
    glm::dmat3 cellEdges = cloud_.voxelToMetres;
    for (int axis = 0; axis < 3; ++axis) cellEdges[axis] *= static_cast<double>(p.cellSize[axis]);
    p.worldToCells = glm::mat3(glm::inverse(cellEdges));
    p.extinction = static_cast<float>(extinction * (1.0 - f * least));
    p.scatterShare = static_cast<float>((1.0 - f) / (1.0 - f * least));
    p.albedo = glm::vec3(medium_.albedo);
    p.straightWeight = least < 1.0 ? glm::vec3((medium_.albedo - least) / (1.0 - least)) : glm::vec3(0.0F);
    p.scatterFraction = static_cast<float>(1.0 - f);
    p.asymmetry = medium_.tables.g;
    p.sunDirection = glm::vec3(-sun.directionTo);
    p.sunCone = static_cast<float>(2.0 * std::pow(std::sin(0.25 * glm::radians(sun.angularDiameter)), 2));
    setFaces(p, faceArea_);
    const double watts = std::ldexp(1.0, -unitExponent);
    p.sunPower = glm::vec3(emission.sunPower(options_.photonsPerGeneration) * watts);
    p.skyPower = glm::vec3(emission.skyPower(options_.photonsPerGeneration) * watts);
    p.photons = static_cast<std::uint32_t>(options_.photonsPerGeneration);
    p.generation = options_.firstGeneration + number;
    p.stream = shared::rngStream(static_cast<std::uint32_t>(options_.seed),
                                 static_cast<std::uint32_t>(options_.seed >> 32U), 0U);
    const glm::uvec4 bits = shared::pcg4d({p.generation, 0xE117U, 0U, p.stream});
    p.sunPhotons = static_cast<std::uint32_t>(
        emission.sunPhotons(options_.photonsPerGeneration, static_cast<double>(bits.x) * 0x1p-32));
    p.collectors = collectors_;
    p.invocations = invocations_;
    p.recordCapacity = recordCapacity_;
    p.stepLimit = stepLimit;
    p.collisionLimit = collisionLimit;
    p.estimatorBase = collectors_ * 3U * static_cast<std::uint32_t>(options_.bands * options_.bands);
    p.estimatorEdge = options_.estimates.edge;
    p.estimatorCells = options_.estimates.cells;
    p.axisBase = p.estimatorBase + shared::estimatorCounts(options_.estimates.cells);
    p.air = airPlace_;
    p.skyAxes = skyAxes_;
    return p;
}

/// Records by collector: a counting sort.
void GenerationTracer::recordSort(const shared::GatherPush& push) {
    commands_.pass("sort");
    commands_.dispatch(scanProgram_,
                       {{"CollectorCounts", collectorCounts_},
                        {"Cursors", cursors_},
                        {"ChunkOffsets", chunkOffsets_},
                        {"GatherArguments", gatherArguments_}},
                       push, {1, 1, 1});
    commands_.barrier("offsets");
    commands_.dispatch(
        scatterProgram_,
        {{"Records", records_}, {"RecordCounts", recordCounts_}, {"Cursors", cursors_}, {"Sorted", sorted_}}, push,
        {invocations_ / 64, std::min(recordCapacity_, sortRows), 1});
    commands_.barrier("sorted records");
}

/// Divides the steps of a round by two: between rounds work can be cut off. Photons go the same ways, however many
/// steps a round has.
void GenerationTracer::shortenRounds() {
    constexpr std::uint32_t fewest = 16;
    std::uint32_t& steps = params_.mapped<shared::TraceParams>()[0].stepLimit;
    steps = std::max(fewest, steps / 2);
}

void GenerationTracer::round(const gpu::Buffer& coefficients) {
    counters_.mapped<shared::TraceCounters>()[0] = {};
    const shared::GatherPush push{collectors_, invocations_, recordCapacity_};
    commands_.begin();
    commands_.pass("trace");
    commands_.fill(collectorCounts_, 0);
    commands_.barrier("counts cleared");
    commands_.dispatch(traceProgram_,
                       {{"density", cloud_.density, Sampler::nearest},
                        {"collectorIndex", cloud_.collectorIndex, Sampler::nearest},
                        {"Params", params_},
                        {"majorants", cloud_.majorantImage},
                        {"InverseCdf", inverseCdf_},
                        {"States", states_},
                        {"Records", records_},
                        {"RecordCounts", recordCounts_},
                        {"CollectorCounts", collectorCounts_},
                        {"Counters", counters_},
                        {"SkyCells", skyCells_},
                        {"SunColours", sunColours_},
                        {"CollisionEstimates", coefficients}},
                       {}, linearGroups(invocations_, 64));
    commands_.barrier("records");
    recordSort(push);
    commands_.pass("gather");
    commands_.dispatchIndirect(gatherProgram_,
                               {{"ChunkOffsets", chunkOffsets_},
                                {"Cursors", cursors_},
                                {"CollectorCounts", collectorCounts_},
                                {"Sorted", sorted_},
                                {"Coefficients", coefficients}},
                               push, gatherArguments_);
    commands_.submit();
    commands_.wait();
}

bool GenerationTracer::trace(const Emission& emission, const scene::Sun& sun, double extinction, int unitExponent,
                             std::uint32_t number, const gpu::Buffer& coefficients, Counters& counters,
                             std::uint64_t& unsettledRecords, PassLog& log, const CutOff& cutOff) {
    params_.mapped<shared::TraceParams>()[0] = traceParams(emission, sun, extinction, unitExponent, number);
    resetStates(states_.mapped<shared::TraceState>().subspan(0, invocations_));
    const shared::TraceCounters& c = counters_.mapped<shared::TraceCounters>()[0];
    std::uint64_t ended = 0;
    counters.emitted += options_.photonsPerGeneration;
    do {
        options_.check();
        const Stopwatch watch;
        round(coefficients);
        if (watch.seconds() > longRound) shortenRounds();
        log.add(commands_);
        counters.events += c.events;
        counters.nulls += c.nulls;
        counters.absorbed += c.absorbed;
        counters.escaped += c.escaped;
        counters.lost += c.lost;
        counters.records += c.records;
        unsettledRecords += c.records;
        requireCountable(unsettledRecords);
        ended += c.absorbed + c.escaped + c.lost;
        if (c.pending == 0 || !cutOff.isDue()) continue;
        if (!cutOff.keepUnfinished) return false;
        counters.lost += options_.photonsPerGeneration - ended;
        break;
    } while (c.pending > 0);
    return true;
}

}  // namespace lumulus::photon
