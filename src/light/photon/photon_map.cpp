#include "light/photon/photon_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <glm/gtx/component_wise.hpp>
#include <numeric>
#include <optional>

#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "light/photon/coefficient_sums.h"
#include "light/photon/emission.h"
#include "light/photon/generation.h"
#include "light/photon/map_limits.h"
#include "shared/collision_estimator.h"
#include "shared/photon.h"
#include "shared/sun_axis.h"

namespace lumulus::photon {

namespace {

namespace spirv {
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
int exponentAbove(double value) {
    return static_cast<int>(std::ceil(std::log2(value)));
}

/// Through the cloud's box, wherever the sun stands: so the ring's unit does not depend on it, and pictures under a sun
/// that came there have the bits of those where it always was.
double greatestFlux(const scene::Sun& sun, const Emission& emission, const glm::dmat3& faceArea) {
    const double area = glm::length(faceArea[0]) + glm::length(faceArea[1]) + glm::length(faceArea[2]);
    return glm::compMax(sun.irradiance * area + emission.skyFlux);
}

/// A texel for each collector.
gpu::Image collectorImage(gpu::Context& context, const char* name, std::uint32_t collectors) {
    const glm::ivec2 extent(shared::COLLECTORS_WIDTH, collectors / shared::COLLECTORS_WIDTH + 1);
    return {context, name, extent, VK_FORMAT_R32G32B32A32_SFLOAT};
}

/// Of all collectors together, where there is room for them.
std::uint32_t coefficientsOf(const gpu::Context& context, std::uint32_t collectors, const Medium& medium,
                             const Options& options) {
    const std::uint64_t rings = medium.tables.axisTable.empty() ? 0 : std::uint64_t{collectors} * shared::AXIS_COUNTS;
    const MapSize size{collectors,
                       options.bands,
                       options.generations,
                       options.keepRing,
                       options.splitGenerations,
                       shared::estimatorCounts(options.estimates.cells) + rings};
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

    CoefficientSums sums;
    GenerationTracer tracer;
    Program<shared::ReconstructPush> reconstructProgram;
    Buffer moments, places, axisTable;
    gpu::Image fluences, colours, radiance;

    double flux = 0.0;             // luminance of the newest generation's light [W]
    glm::dvec3 sunDirection{0.0};  // of travel, of the newest generation's sun
    Counters counters;             // of all generations, also those that were dropped
    PassLog log;
    std::deque<double> ringExtinctions;  // of the generations in the ring, over the medium's
    double newExtinction = 0.0;          // of the generation that waits for keep() or drop()

    /// What drop() goes back to.
    struct Before {
        double flux;
        glm::dvec3 sunDirection;
        Counters counters;
    };
    std::optional<Before> before;

    int unitExponentFor(const Emission& emission, const scene::Sun& sun);
    bool traceLit(const Emission& emission, const scene::Sun& sun, const CutOff& cutOff);
};

PhotonMap::State::State(gpu::Context& gpuContext, const cloud::Asset& preparedCloud, const Medium& theMedium,
                        const Options& theOptions)
    : context(gpuContext),
      cloud(preparedCloud),
      medium(theMedium),
      options(theOptions),
      collectors(static_cast<std::uint32_t>(cloud.collectors.size())),
      sums(context, options, coefficientsOf(context, collectors, medium, options)),
      tracer(context, cloud, medium, options),
      reconstructProgram(context, "reconstruct", spirv::reconstruct_comp,
                         {SpecConstant::of(0, options.bands), SpecConstant::of(1, !medium.tables.axisTable.empty())}),
      moments(context, "band moments", medium.tables.bandMoments.size() * sizeof(float), Memory::device),
      places(context, "collector places", collectors * sizeof(glm::vec4), Memory::device),
      axisTable(context, "axis table", std::max<std::size_t>(1, medium.tables.axisTable.size()) * sizeof(float),
                Memory::device),
      fluences(collectorImage(context, "collector fluences", collectors)),
      colours(collectorImage(context, "collector colours", collectors)),
      radiance(collectorImage(context, "collector radiance", collectors)) {
    gpu::upload(context, moments, medium.tables.bandMoments);
    if (!medium.tables.axisTable.empty()) gpu::upload(context, axisTable, medium.tables.axisTable);
}

/// The unit of a generation's records, and with the first that has light, that of the sum.
int PhotonMap::State::unitExponentFor(const Emission& emission, const scene::Sun& sun) {
    const double most = std::max(glm::compMax(emission.sunPower(options.photonsPerGeneration)),
                                 glm::compMax(emission.skyPower(options.photonsPerGeneration)) * emission.skyPeak);
    if (!sums.hasUnit()) sums.setUnit(exponentAbove(greatestFlux(sun, emission, tracer.faceArea())) - unitBits);
    const int unitExponent = exponentAbove(most / static_cast<double>(shared::POWER_UNITS));
    const int finer = -sums.shiftOf(unitExponent);
    return finer > 0 && finer <= sparedBits ? unitExponent + finer : unitExponent;
}

bool PhotonMap::State::traceLit(const Emission& emission, const scene::Sun& sun, const CutOff& cutOff) {
    const int unitExponent = unitExponentFor(emission, sun);
    const Buffer& into = sums.begin(unitExponent, static_cast<bool>(cutOff.due));
    return tracer.trace(emission, sun, newExtinction, unitExponent, static_cast<std::uint32_t>(sums.kept()), into,
                        counters, sums.records(), log, cutOff);
}

PhotonMap::PhotonMap(gpu::Context& context, const cloud::Asset& cloud, const Medium& medium, const Options& options)
    : state_(std::make_unique<State>(context, cloud, medium, options)) {
    State& s = *state_;
    const std::vector<double> mass = masses();
    std::vector<glm::vec4> places;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i)
        places.emplace_back(cloud.collectors[i].centre, static_cast<float>(mass[i]));
    gpu::upload(context, s.places, places);
}

PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap::~PhotonMap() = default;

void PhotonMap::trace(const scene::Sun& sun, const sky::Environment& environment, std::optional<double> extinction) {
    if (tryTrace(sun, environment, {}, extinction)) keep();
}

bool PhotonMap::tryTrace(const scene::Sun& sun, const sky::Environment& environment, const CutOff& cutOff,
                         std::optional<double> extinction, const AirLight* air) {
    State& s = *state_;
    s.newExtinction = extinction.value_or(s.medium.extinction);
    const glm::dmat3& faces = s.tracer.faceArea();
    const Emission emission = air != nullptr ? makeEmission(sun, *air, faces) : makeEmission(sun, environment, faces);
    if (air != nullptr) s.tracer.setAir(*air);
    s.before = State::Before{s.flux, s.sunDirection, s.counters};
    s.flux = luminance(emission.sunFlux + emission.skyFlux);
    s.sunDirection = -sun.directionTo;
    if (emission.dark()) {
        s.sums.beginDark();
        return true;
    }
    try {
        if (s.traceLit(emission, sun, cutOff)) return true;
    } catch (...) {
        drop();
        throw;
    }
    drop();
    return false;
}

void PhotonMap::keep() {
    State& s = *state_;
    s.sums.keep();
    s.before.reset();
    s.ringExtinctions.push_back(s.newExtinction / s.medium.extinction);
    if (s.options.keepRing && s.sums.kept() > s.options.generations) s.ringExtinctions.pop_front();
}

void PhotonMap::drop() {
    State& s = *state_;
    s.sums.drop();
    if (!s.before) return;
    s.flux = s.before->flux;
    s.sunDirection = s.before->sunDirection;
    s.counters = s.before->counters;
    s.before.reset();
}

std::uint64_t PhotonMap::shrinkGenerations(std::uint64_t divisor, std::uint64_t fewest) {
    State& s = *state_;
    assert(s.sums.kept() == 0);
    std::uint64_t& photons = s.options.photonsPerGeneration;
    photons = std::min(photons, std::max(fewest, photons / divisor));
    s.tracer.setPhotons(photons);
    return photons;
}

Light PhotonMap::light(Part part) {
    State& s = *state_;
    if (part != Part::all) return s.sums.half(part == Part::even);
    // Σ c over Σ M: equal extinctions give exactly the number of generations
    const double masses = std::accumulate(s.ringExtinctions.begin(), s.ringExtinctions.end(), 0.0);
    settle();
    const Light sum = s.sums.all();
    return {sum.counts, sum.unit / (masses > 0.0 ? masses : 1.0)};
}

void PhotonMap::reconstruct(gpu::Commands& commands, const glm::vec3& eyeVoxel, const Light& light) {
    State& s = *state_;
    shared::ReconstructPush push{};
    push.collectors = s.collectors;
    push.scale = static_cast<float>(light.unit);
    push.eye = eyeVoxel;
    push.voxelToWorld = glm::mat3(s.cloud.voxelToMetres);
    push.sunDirection = glm::vec3(s.sunDirection);
    push.axisBase = estimatorBase() + shared::estimatorCounts(s.options.estimates.cells);
    push.angleScale = s.medium.tables.angleScale;
    commands.pass("reconstruct");
    commands.dispatch(s.reconstructProgram,
                      {{"Sum", *light.counts},
                       {"Moments", s.moments},
                       {"Collectors", s.places},
                       {"fluences", s.fluences},
                       {"radiance", s.radiance},
                       {"colours", s.colours},
                       {"AxisTable", s.axisTable}},
                      push, linearGroups(s.collectors, 64));
}

void PhotonMap::settle() {
    state_->sums.settle();
}

const gpu::Image& PhotonMap::radiance() const {
    return state_->radiance;
}
const gpu::Image& PhotonMap::fluences() const {
    return state_->fluences;
}
const gpu::Image& PhotonMap::colours() const {
    return state_->colours;
}
int PhotonMap::generationsInRing() const {
    const int kept = state_->sums.kept();
    return state_->options.keepRing ? std::min(kept, state_->options.generations) : kept;
}
SplitCounts PhotonMap::splitCounts() const {
    return state_->sums.splitCounts();
}
std::uint32_t PhotonMap::estimatorBase() const {
    return state_->collectors * 3U * static_cast<std::uint32_t>(state_->options.bands * state_->options.bands);
}
double PhotonMap::photonPower() const {
    const double photons = static_cast<double>(state_->options.photonsPerGeneration) * std::max(1, generationsInRing());
    return state_->flux / photons;
}
std::uint64_t PhotonMap::firstInRing() const {
    return state_->options.firstGeneration + static_cast<std::uint64_t>(state_->sums.kept() - generationsInRing());
}
std::uint64_t PhotonMap::photonsInRing() const {
    return state_->options.photonsPerGeneration * static_cast<std::uint64_t>(generationsInRing());
}
Counters PhotonMap::counters() const {
    Counters counters = state_->counters;
    counters.saturated = state_->sums.saturated();
    return counters;
}
std::vector<gpu::PassTime> PhotonMap::times() const {
    std::vector<gpu::PassTime> times = state_->log.times;
    const std::vector<gpu::PassTime>& sums = state_->sums.log().times;
    times.insert(times.end(), sums.begin(), sums.end());
    return times;
}
const std::vector<gpu::Step>& PhotonMap::steps() const {
    return state_->log.steps;
}
double PhotonMap::unit() const {
    return std::ldexp(1.0, state_->sums.baseExponent());
}

std::vector<std::int64_t> PhotonMap::downloadSum() {
    state_->sums.settleAll();
    auto values = gpu::download<std::int64_t>(state_->context, state_->sums.startedSum());
    values.resize(state_->sums.coefficients());
    return values;
}

std::vector<std::int64_t> PhotonMap::downloadSlot(int slot) const {
    auto values = gpu::download<std::int64_t>(state_->context, state_->sums.slots().at(static_cast<std::size_t>(slot)));
    values.resize(state_->sums.coefficients());
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
