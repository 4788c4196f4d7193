#include "light/photon/generation.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/stopwatch.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "light/photon/map_limits.h"
#include "light/photon/surroundings.h"
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
/// The same of a round that may not last long, while nothing is known of the cloud, and the fewest of any round.
constexpr std::uint32_t firstSteps = 128, fewestSteps = 32;
/// A round of few photons that are left may have this many times as many steps.
constexpr double mostTailSteps = 16.0;
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

GenerationTracer::GenerationTracer(gpu::Context& context, const MapPart& part, const Options& options)
    : GenerationTracer(context,
                       {&part, nullptr, traceSpirv(),
                        withSurroundings(traceConstants(part.medium.tables, part.medium.albedo, false,
                                                        part.asset->isSparse(), options.air),
                                         options, true),
                        part.collectors, part.estimatorBase + shared::estimatorCounts(part.estimates.cells)},
                       options) {}

GenerationTracer::GenerationTracer(gpu::Context& context, const WorldWalk& walk, std::uint32_t collectors,
                                   std::uint32_t axisBase, const Options& options)
    : GenerationTracer(
          context,
          {nullptr, &walk, walk.spirv(), withSurroundings(walk.constants(options.air), options), collectors, axisBase},
          options) {}

GenerationTracer::GenerationTracer(gpu::Context& context, const Walked& walked, const Options& options)
    : part_(walked.part),
      world_(walked.world),
      axisBase_(walked.axisBase),
      options_(options),
      collectors_(walked.collectors),
      invocations_(invocationsFor(context, options.photonsPerGeneration)),
      recordCapacity_(capacityFor(options.photonsPerGeneration, invocations_)),
      faceArea_(part_ != nullptr ? faceAreas(part_->voxelToMetres, glm::dvec3(part_->asset->size)) : glm::dmat3(0.0)),
      traceProgram_(context, "trace", walked.spirv, walked.constants),
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
      inverseCdf_(context, "inverse cdf", part_ != nullptr ? part_->medium.tables.inverseCdf.size() * sizeof(float) : 0,
                  Memory::device),
      skyCells_(context, "sky cells",
                options.air
                    ? static_cast<std::uint64_t>(options.skyCells.x * options.skyCells.y) * sizeof(shared::SkyCell)
                    : 0,
                Memory::host),
      sunColours_(
          context, "sun colours",
          options.air ? std::uint64_t{shared::SUN_COLOUR_COLUMNS} * shared::SUN_COLOUR_ROWS * sizeof(glm::vec3) : 0,
          Memory::host),
      fogSky_(context, "fog sky",
              options.fog ? std::uint64_t{shared::FOG_SKY_HEIGHTS} * (sky::SkyMaps::cells + 1) * sizeof(glm::vec3) : 0,
              Memory::host),
      commands_(context) {
    if (world_ != nullptr) starts_.emplace(context, *world_, options, invocations_);
    if (part_ != nullptr && !part_->medium.tables.inverseCdf.empty())
        gpu::upload(context, inverseCdf_, part_->medium.tables.inverseCdf);
}

glm::dmat3 GenerationTracer::cellsToWorld() const {
    if (world_ != nullptr) return glm::dmat3(world_->cellEdge());
    glm::dmat3 edges = part_->voxelToMetres;
    for (int axis = 0; axis < 3; ++axis) edges[axis] *= static_cast<double>(part_->asset->majorants.cellSize[axis]);
    return edges;
}

/// Where the one cloud and its medium are described.
void GenerationTracer::setCloud(shared::TraceParams& p, double extinction) const {
    const Medium& medium = part_->medium;
    const double f = static_cast<double>(medium.tables.forwardFraction);
    const double least = std::min(medium.albedo.x, std::min(medium.albedo.y, medium.albedo.z));
    p.size = glm::vec3(part_->asset->size);
    p.cells = part_->asset->majorants.cells;
    p.cellSize = part_->asset->majorants.cellSize;
    p.worldToCells = glm::mat3(glm::inverse(cellsToWorld()));
    p.extinction = static_cast<float>(extinction * (1.0 - f * least));
    p.scatterShare = static_cast<float>((1.0 - f) / (1.0 - f * least));
    p.albedo = glm::vec3(medium.albedo);
    p.straightWeight = least < 1.0 ? glm::vec3((medium.albedo - least) / (1.0 - least)) : glm::vec3(0.0F);
    p.scatterFraction = static_cast<float>(1.0 - f);
    p.asymmetry = medium.tables.g;
    p.estimatorBase = part_->estimatorBase;
    p.estimatorEdge = part_->estimates.edge;
    p.estimatorCells = part_->estimates.cells;
    setFaces(p, faceArea_);
}

void GenerationTracer::setAir(const AirLight& air) {
    std::ranges::copy(air.cells, skyCells_.mapped<shared::SkyCell>().begin());
    std::ranges::copy(air.sunColours, sunColours_.mapped<glm::vec3>().begin());
    if (options_.fog) std::ranges::copy(air.fogSky, fogSky_.mapped<glm::vec3>().begin());
    airPlace_ = air.place;
    skyAxes_ = glm::mat3(air.skyFrame.axes);
}

shared::TraceParams GenerationTracer::traceParams(const Emission& emission, const scene::Sun& sun, double extinction,
                                                  int unitExponent, std::uint32_t number) const {
    shared::TraceParams p{};
    p.sunDirection = glm::vec3(-sun.directionTo);
    p.sunCone = static_cast<float>(2.0 * std::pow(std::sin(0.25 * glm::radians(sun.angularDiameter)), 2));
    if (part_ != nullptr)
        setCloud(p, extinction);
    else
        world_->setParams(p);
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
    p.axisBase = axisBase_;
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

/// Chooses the steps of the next round: between rounds work can be cut off. Photons go the same ways, however many
/// steps a round has.
void GenerationTracer::planRound(const CutOff& cutOff, std::uint32_t pending) {
    if (!cutOff.roundSeconds) return;
    double steps = stepSeconds_ > 0.0 ? cutOff.roundSeconds() / stepSeconds_ : firstSteps;
    if (pending > 0) steps *= std::min(mostTailSteps, static_cast<double>(invocations_) / pending);
    params_.mapped<shared::TraceParams>()[0].stepLimit =
        static_cast<std::uint32_t>(std::clamp(steps, static_cast<double>(fewestSteps), static_cast<double>(stepLimit)));
}

/// Learns from a round that took so many seconds and left so many invocations with photons to go on with. Where most
/// have none left, steps are cheaper than those of the next generation will be.
void GenerationTracer::learnRound(double seconds, std::uint32_t pending) {
    std::uint32_t& steps = params_.mapped<shared::TraceParams>()[0].stepLimit;
    if (2 * pending > invocations_) stepSeconds_ = std::max(seconds / steps, 0.5 * stepSeconds_);
    if (seconds > longRound) steps = std::max(fewestSteps, steps / 2);
    if (seconds < 0.25 * longRound) steps = std::min(stepLimit, 2 * steps);  // where others had the machine for a while
}

std::vector<gpu::Binding> GenerationTracer::walkBindings() const {
    if (world_ != nullptr) return world_->bindings();
    const cloud::Asset& cloud = *part_->asset;
    return {{"density", *cloud.density, Sampler::nearest},
            {"bricks", cloud.brickIndex(), Sampler::nearest},
            {"collectorIndex", cloud.collectorIndex, Sampler::nearest},
            {"majorants", cloud.majorantImage},
            {"InverseCdf", inverseCdf_}};
}

void GenerationTracer::round(const gpu::Buffer& coefficients) {
    counters_.mapped<shared::TraceCounters>()[0] = {};
    const shared::GatherPush push{collectors_, invocations_, recordCapacity_};
    std::vector<gpu::Binding> bindings = walkBindings();
    bindings.insert(bindings.end(), {{"Params", params_},
                                     {"States", states_},
                                     {"Records", records_},
                                     {"RecordCounts", recordCounts_},
                                     {"CollectorCounts", collectorCounts_},
                                     {"Counters", counters_},
                                     {"SkyCells", skyCells_},
                                     {"SunColours", sunColours_},
                                     {"FogSky", fogSky_},
                                     {"CollisionEstimates", coefficients},
                                     {"GroundLight", ground_ != nullptr ? *ground_ : params_}});
    const gpu::Binding meshes{"MeshShade", meshes_ != nullptr ? *meshes_ : params_};
    commands_.begin();
    if (starts_) {
        std::vector<gpu::Binding> ofStarts = bindings;
        ofStarts.push_back(meshes);
        starts_->record(commands_, ofStarts, params_.mapped<shared::TraceParams>()[0].stepLimit);
        bindings.push_back(starts_->binding());
    } else {
        bindings.push_back(meshes);
    }
    commands_.pass("trace");
    commands_.fill(collectorCounts_, 0);
    commands_.barrier("counts cleared");
    commands_.dispatch(traceProgram_, bindings, {}, linearGroups(invocations_, 64));
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
    counters_.mapped<shared::TraceCounters>()[0].pending = 0;
    do {
        options_.check();
        planRound(cutOff, c.pending);
        const Stopwatch watch;
        round(coefficients);
        learnRound(watch.seconds(), c.pending);
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
