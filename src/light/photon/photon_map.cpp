#include "light/photon/photon_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <optional>
#include <utility>

#include "light/photon/photon_map_state.h"
#include "shared/collision_estimator.h"
#include "shared/photon.h"

namespace lumulus::photon {

namespace {

using gpu::Buffer;

/// The ring counts in 2⁻⁴² of the greatest flux that the first generation's lights may have: 2⁻²⁵ of a photon's power
/// at 1e5 photons, and 2¹⁹ times the flux before saturation.
constexpr int unitBits = 42;
/// Of a record's 20 bits of power, given up where the ring then takes a generation of many photons as it is: without a
/// ring generations then add up in one buffer, instead of a pass over all of it after each.
constexpr int sparedBits = 4;
int exponentAbove(double value) {
    return static_cast<int>(std::ceil(std::log2(value)));
}

}  // namespace

PhotonMap::State::State(gpu::Context& gpuContext, std::vector<MapPart> theParts, const cloud::SharedVolumes* volumes,
                        const Options& theOptions)
    : context(gpuContext),
      parts(std::move(theParts)),
      options(theOptions),
      axisBase(layOut(parts, options.bands)),
      collectors(collectorsOf(parts)),
      sums(context, options, coefficientsOf(context, parts, options)),
      walk(volumes != nullptr ? std::optional<WorldWalk>(std::in_place, context, parts, *volumes) : std::nullopt),
      tracer(walk ? GenerationTracer(context, *walk, collectors, axisBase, options)
                  : GenerationTracer(context, parts.front(), options)),
      reconstruction(context, parts, options.bands) {
    if (options.ground) groundWalk.emplace(context, groundBase(parts, axisBase));
}

/// Of several instances all light counts that is not for certain beside all of them.
Emission PhotonMap::State::emissionOf(const scene::Sun& sun, const sky::Environment& environment,
                                      const AirLight* air) const {
    if (air != nullptr)
        return walk ? makeEmission(sun, *air, walk->largestWeight()) : makeEmission(sun, *air, tracer.faceArea());
    if (ground) {  // its photons start like those of the sky, and have their share of the brightest of both
        scene::Sky brightest;
        brightest.radiance = ground->brightest();
        return emissionUnder(sun, sky::Environment(brightest));
    }
    return emissionUnder(sun, environment);
}

Emission PhotonMap::State::emissionUnder(const scene::Sun& sun, const sky::Environment& environment) const {
    if (!walk) return makeEmission(sun, environment, tracer.faceArea());
    return makeEmission(sun, environment, walk->largestWeight());
}

/// The unit of a generation's records, and with the first that has light, that of the sum.
int PhotonMap::State::unitExponentFor(const Emission& emission, const glm::dvec3& greatest) {
    const double most = std::max(glm::compMax(emission.sunPower(options.photonsPerGeneration)),
                                 glm::compMax(emission.skyPower(options.photonsPerGeneration)) * emission.skyPeak);
    const double flux = walk ? greatestFlux(greatest, emission, walk->area(), walk->largestWeight())
                             : greatestFlux(greatest, emission, tracer.faceArea());
    if (!sums.hasUnit()) sums.setUnit(exponentAbove(flux) - unitBits);
    const int unitExponent = exponentAbove(most / static_cast<double>(shared::POWER_UNITS));
    const int finer = -sums.shiftOf(unitExponent);
    return finer > 0 && finer <= sparedBits ? unitExponent + finer : unitExponent;
}

bool PhotonMap::State::traceLit(const Emission& emission, const scene::Sun& sun, const glm::dvec3& greatest,
                                const CutOff& cutOff) {
    const int unitExponent = unitExponentFor(emission, greatest);
    const Buffer& into = sums.begin(unitExponent, static_cast<bool>(cutOff.due));
    return tracer.trace(emission, sun, newExtinction, unitExponent, static_cast<std::uint32_t>(sums.kept()), into,
                        counters, sums.records(), log, cutOff);
}

/// Means over the ring of the extinction of a part, over that of its medium.
double PhotonMap::State::meanExtinction(std::size_t part) const {
    if (ringExtinctions.empty()) return 1.0;
    double sum = 0.0;
    for (const std::vector<double>& generation : ringExtinctions) sum += generation[part];
    // of a part that no generation has seen yet there is no light to divide
    return sum > 0.0 ? sum / static_cast<double>(ringExtinctions.size()) : 1.0;
}

/// Where the collectors of several instances are, and their masses.
void PhotonMap::State::placeCollectors() {
    std::vector<double> extinctions;
    for (std::size_t i = 0; i < parts.size(); ++i) extinctions.push_back(meanExtinction(i));
    std::vector<glm::vec4> texels;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const MapPart& part = parts[i];
        if (!part.collects) continue;
        for (const cloud::Collector& collector : part.asset->collectors) {
            const glm::dvec3 place =
                places[i].origin - walk->corner() + part.voxelToMetres * glm::dvec3(collector.centre);
            const double mass = static_cast<double>(collector.mass) * part.massScale() * extinctions[i];
            texels.emplace_back(glm::vec3(place), static_cast<float>(mass));
        }
    }
    reconstruction.setPlaces(texels);
}

PhotonMap::PhotonMap(gpu::Context& context, const cloud::Asset& cloud, const Medium& medium, const Options& options)
    : PhotonMap(context, cloud, cloud.voxelToMetres, medium, options) {}

PhotonMap::PhotonMap(gpu::Context& context, const cloud::Asset& cloud, const glm::dmat3& voxelToMetres,
                     const Medium& medium, const Options& options)
    : state_(std::make_unique<State>(context, std::vector{onlyPart(cloud, voxelToMetres, medium, options)}, nullptr,
                                     options)) {
    State& s = *state_;
    const std::vector<double> mass = masses();
    std::vector<glm::vec4> places;
    for (std::size_t i = 0; i < cloud.collectors.size(); ++i)
        places.emplace_back(cloud.collectors[i].centre, static_cast<float>(mass[i]));
    s.reconstruction.setPlaces(places);
}

PhotonMap::PhotonMap(gpu::Context& context, std::vector<MapPart> parts, const cloud::SharedVolumes& volumes,
                     const Options& options)
    : state_(std::make_unique<State>(context, std::move(parts), &volumes, options)) {}

void PhotonMap::place(std::span<const Placement> places) {
    State& s = *state_;
    if (std::ranges::equal(places, s.places)) return;
    s.walk->place(places);
    s.places.assign(places.begin(), places.end());
    s.placeCollectors();
}

PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap::~PhotonMap() = default;

void PhotonMap::trace(const scene::Sun& sun, const sky::Environment& environment, std::optional<double> extinction) {
    if (tryTrace(sun, environment, {}, extinction)) keep();
}

bool PhotonMap::tryTrace(const scene::Sun& sun, const sky::Environment& environment, const CutOff& cutOff,
                         std::optional<double> extinction, const AirLight* air) {
    State& s = *state_;
    s.newExtinction = extinction.value_or(s.parts.front().medium.extinction);
    std::vector<double> extinctions;
    for (std::size_t i = 0; i < s.parts.size(); ++i) {
        const double own = s.parts[i].medium.extinction;
        extinctions.push_back((s.walk ? s.places[i].extinction : s.newExtinction) / own);
    }
    std::optional<AirLight> scaled;
    if (air != nullptr && s.walk) scaled = forArea(*air, s.walk->largestWeight(), s.walk->corner());
    if (scaled) air = &*scaled;
    const Emission emission = s.emissionOf(sun, environment, air);
    if (air != nullptr) s.tracer.setAir(*air);
    s.begun = State::Begun{
        {luminance(emission.sunFlux + emission.skyFlux), -sun.directionTo}, std::move(extinctions), s.counters};
    if (emission.dark()) {
        s.sums.beginDark();
        return true;
    }
    try {
        // a ring that began in twilight holds noon too
        const glm::dvec3& greatest = air != nullptr && s.options.keepRing ? air->sunAbove : sun.irradiance;
        if (s.traceLit(emission, sun, greatest, cutOff)) return true;
    } catch (...) {
        drop();
        throw;
    }
    drop();
    return false;
}

void PhotonMap::setGround(const Ground& ground) {
    State& s = *state_;
    s.ground = ground;
    s.groundWalk->set(ground, s.tracer.cellsToWorld());
    s.tracer.setGround(s.groundWalk->buffer());
}

void PhotonMap::setMeshes(const gpu::Buffer& meshes) {
    state_->tracer.setMeshes(meshes);
}

glm::dmat3 PhotonMap::cellsToWorld() const {
    return state_->tracer.cellsToWorld();
}

std::vector<glm::vec3> PhotonMap::groundLight() {
    return state_->groundWalk->download(light());
}

void PhotonMap::keep() {
    State& s = *state_;
    const State::Begun begun = *std::exchange(s.begun, std::nullopt);
    s.sums.keep();
    s.newest = begun.lit;
    s.ringExtinctions.push_back(begun.extinctions);
    if (s.options.keepRing && s.sums.kept() > s.options.generations) s.ringExtinctions.pop_front();
    if (s.walk) s.placeCollectors();
}

void PhotonMap::drop() {
    State& s = *state_;
    s.sums.drop();
    if (!s.begun) return;
    s.counters = s.begun->countersBefore;
    s.begun.reset();
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
    // Σ c over Σ M: equal extinctions give exactly the number of generations. Of several clouds the places of the
    // collectors have the means.
    double masses = s.walk ? static_cast<double>(s.ringExtinctions.size()) : 0.0;
    if (!s.walk)
        for (const std::vector<double>& generation : s.ringExtinctions) masses += generation.front();
    settle();
    const Light sum = s.sums.all();
    return {sum.counts, sum.unit / (masses > 0.0 ? masses : 1.0)};
}

void PhotonMap::reconstruct(gpu::Commands& commands, const glm::vec3& eye, const Light& light) {
    const State& s = *state_;
    shared::ReconstructPush push{};
    push.scale = static_cast<float>(light.unit);
    push.eye = eye;
    push.voxelToWorld = s.walk ? glm::mat3(1.0F) : glm::mat3(s.parts.front().voxelToMetres);
    push.sunDirection = glm::vec3(s.newest.sunDirection);
    push.axisBase = s.axisBase;
    s.reconstruction.record(commands, *light.counts, push);
}

glm::dvec3 PhotonMap::corner() const {
    return state_->walk->corner();
}

const std::vector<MapPart>& PhotonMap::parts() const {
    return state_->parts;
}

void PhotonMap::settle() {
    state_->sums.settle();
}

const gpu::Image& PhotonMap::radiance() const {
    return state_->reconstruction.radiance();
}
const gpu::Image& PhotonMap::fluences() const {
    return state_->reconstruction.fluences();
}
const gpu::Image& PhotonMap::colours() const {
    return state_->reconstruction.colours();
}
int PhotonMap::generationsInRing() const {
    const int kept = state_->sums.kept();
    return state_->options.keepRing ? std::min(kept, state_->options.generations) : kept;
}
SplitCounts PhotonMap::splitCounts() const {
    return state_->sums.splitCounts();
}
double PhotonMap::photonPower(std::size_t part) const {
    const State& s = *state_;
    const double photons = static_cast<double>(s.options.photonsPerGeneration) * std::max(1, generationsInRing());
    return s.newest.flux / photons * (s.walk ? s.walk->meanWeight(part) / s.walk->largestWeight() : 1.0);
}
std::uint64_t PhotonMap::photonsOf(std::size_t part) const {
    const State& s = *state_;
    if (!s.walk) return photonsInRing();
    return static_cast<std::uint64_t>(static_cast<double>(photonsInRing()) * s.parts[part].share);
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
std::vector<double> PhotonMap::meanExtinctions() const {
    std::vector<double> means;
    for (std::size_t i = 0; i < state_->parts.size(); ++i) means.push_back(state_->meanExtinction(i));
    return means;
}
double PhotonMap::unit() const {
    return std::ldexp(1.0, state_->sums.baseExponent());
}

double PhotonMap::massScale(std::size_t part) const {
    const State& s = *state_;
    return s.parts[part].massScale() * (s.walk ? s.meanExtinction(part) : 1.0);
}

std::vector<double> PhotonMap::masses() const {
    std::vector<double> result;
    for (const MapPart& part : state_->parts) {
        if (!part.collects) continue;
        for (const cloud::Collector& collector : part.asset->collectors)
            result.push_back(static_cast<double>(collector.mass) * part.massScale());
    }
    return result;
}

}  // namespace lumulus::photon
