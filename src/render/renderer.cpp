#include "render/renderer.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/error.h"
#include "base/stopwatch.h"
#include "frame/background.h"
#include "frame/view_params.h"
#include "light/photon/traced_sums.h"
#include "render/changes.h"
#include "render/drawable.h"
#include "render/frame_light.h"
#include "render/light_fingerprint.h"
#include "render/picture.h"
#include "render/renderer_state.h"
#include "render/renderer_statistics.h"
#include "render/world_media.h"

namespace lumulus {

ViewState::ViewState() : state_(std::make_unique<State>()) {}
ViewState::ViewState(ViewState&&) noexcept = default;
ViewState& ViewState::operator=(ViewState&&) noexcept = default;
ViewState::~ViewState() = default;

Renderer::Renderer(const scene::Scene& scene, const RendererOptions& options)
    : state_(std::make_unique<State>(
          drawable(scene), options,
          options.context ? options.context
                          : std::make_shared<gpu::Context>(gpu::ContextOptions{options.device, options.validation}))) {
    State& s = *state_;
    WorldReport report;
    s.world.emplace(makeWorld(s.context, scene,
                              {options.keepRing, options.progressive, s.report, options.loaded, s.check, options.read,
                               keptOn(s.ownContext, options.kept)},
                              report));
    s.statistics.warnings = std::move(report.warnings);
    s.statistics.clouds = std::move(report.clouds);
    s.statistics.assets = std::move(report.assets);
    s.statistics.loadSeconds = report.loadSeconds;
    const Stopwatch preparing;
    s.makePainters(scene);
    s.statistics.prepareSeconds = report.prepareSeconds + preparing.seconds();
}

Renderer::Renderer(const scene::Scene& scene, const Renderer& other, const RendererOptions& options)
    : state_(std::make_unique<State>(drawable(scene), options, other.state_->ownContext)) {
    State& s = *state_;
    const Stopwatch preparing;
    s.world.emplace(makeWorldBeside(
        s.context, scene, *other.state_->world,
        {options.keepRing, options.progressive, s.report, {}, s.check, {}, keptOn(s.ownContext, options.kept)}));
    for (std::size_t i = 0; i < s.world->light.size(); ++i)
        s.world->light[i].layouts = other.state_->world->light[i].layouts;
    s.statistics.warnings = other.state_->statistics.warnings;
    s.statistics.clouds = other.state_->statistics.clouds;
    for (const AssetSummary& asset : other.state_->statistics.assets)
        s.statistics.assets.push_back(asset.withoutTimes());
    s.makePainters(scene);
    s.statistics.prepareSeconds = preparing.seconds();
}

Renderer::Renderer(const scene::Scene& scene, Renderer& other, std::span<const CloudOrigin> origins,
                   const RendererOptions& options)
    : state_(std::make_unique<State>(drawable(scene), options, other.state_->ownContext)) {
    State& s = *state_;
    State& before = *other.state_;
    const Stopwatch preparing;
    s.world.emplace(makeEditedWorld(s.context, scene, *before.world, origins,
                                    {options.keepRing, options.progressive, s.report, {}, s.check, {}, nullptr}));
    s.world->wind = before.world->wind;
    for (std::size_t i = 0; i < origins.size(); ++i) {
        s.world->light[i].layouts = before.world->light[origins[i].from].layouts;
        s.statistics.clouds.push_back(before.statistics.clouds.at(origins[i].from));
        const auto moved = before.moved.find(origins[i].from);
        if (moved != before.moved.end() && !origins[i].added) s.moved[i] = moved->second;
    }
    setTime(0.0);
    s.statistics.warnings = before.statistics.warnings;
    s.makePainters(scene);
    s.statistics.prepareSeconds = preparing.seconds();
}

void Renderer::State::makePainters(const scene::Scene& scene) {
    statistics.device = context.device().name;
    if (!scene.fog.media.empty()) fog.emplace(context, world->fog, check);
    if (world->fogLight)
        litFog.emplace(context,
                       fog::LitFog::Has{world->hasShadows() || (world->meshes && world->lights.hasSun()),
                                        world->sharedShadow.has_value(), world->lights.ground || world->airOverFog,
                                        world->airOverFog != nullptr, changesFog(*world)});
    if (changesFog(*world)) fogChange.emplace(context, *world, check);
    if (world->shadedGround() != nullptr) ground.emplace(keepRing);
    for (const auto& asset : world->assets) statistics.collectors += asset->collectors.size();
    requireDrawableMeshes(scene, keepRing);
    if (world->meshes) setMeshes(scene);
    if (!world->visible().empty()) painter.emplace(context, *world, scene.draw, meshes.has_value());
}

Renderer::~Renderer() = default;

int Renderer::generationsWanted() const {
    return state_->world->hasPhotons() ? state_->world->photonMap.generations : 0;
}

void Renderer::traceGeneration() {
    traceGeneration({});
}

bool Renderer::traceGeneration(const CutOff& cutOff) {
    State& s = *state_;
    const Stopwatch watch;
    std::optional<photon::Ground> ground;
    if (s.ground && s.world->photons) ground = s.ground->forPhotons(s.context, *s.world);
    s.tracesLightOfNow = true;
    const bool finished = traceAll(*s.world, cutOff, ground ? &*ground : nullptr);
    if (finished && s.tracesLightOfNow) ++s.sinceChange;
    s.statistics.traceSeconds += watch.seconds();
    return finished;
}

std::shared_ptr<gpu::Context> Renderer::context() const {
    return state_->ownContext;
}

photon::TracedSums Renderer::tracedSums() {
    std::optional<photon::PhotonMap>& photons = state_->world->photons;
    return photons ? photons->tracedSums() : photon::TracedSums{};
}

void Renderer::goOnFrom(const photon::TracedSums& sums) {
    State& s = *state_;
    if (s.world->photons) s.world->photons->goOnFrom(sums);
}

std::optional<FrameLight> Renderer::frameLight(const scene::Scene& scene) {
    return frameLightOf(state_->context, *state_->world, scene);
}

std::uint64_t Renderer::frameLightBytes() const {
    return lumulus::frameLightBytes(*state_->world);
}

bool Renderer::carryOn(const scene::Scene& scene, const FrameLight& before, std::span<const photon::Way> ways,
                       int generations) {
    return carryLight(state_->context, *state_->world, scene, before, ways, generations);
}

bool Renderer::goOnFrom(const scene::Scene& scene, const FrameLight& before, std::span<const photon::Way> ways) {
    return carryRing(state_->context, *state_->world, scene, before, ways, state_->check);
}

std::string Renderer::lightFingerprint(const scene::Scene& scene) {
    return lumulus::lightFingerprint(state_->context, *state_->world, scene);
}

std::uint64_t Renderer::shrinkGenerations(std::uint64_t divisor, std::uint64_t fewest) {
    std::optional<photon::PhotonMap>& photons = state_->world->photons;
    return photons ? photons->shrinkGenerations(divisor, fewest) : 0;
}

View Renderer::sceneView() const {
    View view;
    view.camera = state_->camera;
    view.image = state_->image;
    return view;
}

const Bounds& Renderer::bounds() const {
    return state_->world->bounds;
}

int Renderer::State::raysAcross(const Camera& seen, int most) const {
    int rays = 1;
    for (const std::size_t i : world->visible()) rays = std::max(rays, raysOf(*world, i, seen));
    return std::min(most, rays);
}

int Renderer::raysAcross(const View& view) const {
    return state_->raysAcross(makeCamera(view, state_->world->bounds), view.mostRays);
}

void Renderer::State::show(ViewState::State& state, const View& view) const {
    state.previous = state.camera;
    state.camera = makeCamera(view, world->bounds);
    if (world->lights.ground) requireAbove(*world->lights.ground, state.camera);
    state.tile = drawnTile(view);
    state.sunDisc = view.sunDisc;
    state.coarse = view.coarse;
    state.raysAcross = raysAcross(state.camera, view.mostRays);
    state.spacing = painter ? painter->samplingSpacing(*world, state.camera) : 1;
}

LayeredImage Renderer::draw() {
    return draw(sceneView());
}

LayeredImage Renderer::draw(const View& view) {
    ViewState state;
    return draw(view, state);
}

LayeredImage Renderer::draw(const View& view, ViewState& viewState) {
    State& s = *state_;
    const Stopwatch watch;
    s.show(viewState.state(), view);
    const std::vector<gpu::PassTime> ofPictureAround = std::exchange(s.work.times, {});
    if (s.world->photons) {
        s.world->photons->settle();
        frame::addTimes(s.work.times, s.world->photons->times());
    }
    PictureOrder order{s.work,
                       *s.world,
                       s.painter ? &*s.painter : nullptr,
                       s.fog ? &*s.fog : nullptr,
                       s.litFog ? &*s.litFog : nullptr,
                       s.fogChange ? &*s.fogChange : nullptr,
                       s.ground ? &*s.ground : nullptr,
                       nullptr,
                       s.world->photonMap.bands,
                       s.sunAllowed,
                       s.check,
                       s.report};
    if (s.meshes) {
        s.lightMeshes(order);
        order.meshes = &*s.meshes;
    }
    LayeredImage image = order.picture(viewState.state(), view);
    if (!s.lamps.empty() && view.image.background) s.addLamps(image, viewState.state().camera, view);
    s.statistics.passes.clear();
    addTimes(s.statistics, s.work.times);
    s.work.times = ofPictureAround;
    s.statistics.gpuBytes = s.context.memory().used;
    s.statistics.gpuBytesHeld = s.context.memory().held;
    s.statistics.fogChangeBytes = s.fogChange ? s.fogChange->bytes() : 0;
    s.statistics.drawSeconds += watch.seconds();
    return image;
}

Preview Renderer::preview() {
    State& s = *state_;
    ViewState viewState;
    s.show(viewState.state(), sceneView());
    PictureOrder order{
        s.work,       *s.world, &*s.painter, nullptr, nullptr, nullptr, nullptr, nullptr, s.world->photonMap.bands,
        s.sunAllowed, s.check,  noReport};
    Preview preview = order.preview(viewState.state());
    if (!s.image.background)
        for (LayeredImage* image : {&preview.even, &preview.odd}) frame::leaveOutBackground(*image);
    s.statistics.gpuBytes = s.context.memory().used;
    s.statistics.gpuBytesHeld = s.context.memory().held;
    return preview;
}

std::vector<std::string> Renderer::clouds() const {
    std::vector<std::string> names;
    for (const cloud::Instance& instance : state_->world->instances) names.push_back(instance.name);
    return names;
}

std::size_t Renderer::findCloud(std::string_view nameOrIndex) const {
    return findInstance(*state_->world, nameOrIndex);
}

const scene::Sun& Renderer::sun() const {
    return state_->world->lights.sun;
}

double Renderer::extinction(std::size_t cloud) const {
    const auto& instances = state_->world->instances;
    return cloud < instances.size() ? instances[cloud].sceneExtinction : 0.0;
}

Generations Renderer::generations() const {
    Generations result;
    if (const auto& photons = state_->world->photons) {
        result.first = photons->firstInRing();
        result.count = photons->generationsInRing();
        result.current = std::min(result.count, state_->sinceChange);
        result.photonsEach = photons->photonsInRing() / static_cast<std::uint64_t>(std::max(1, result.count));
    }
    return result;
}

void Renderer::State::lightChanged() {
    assert(keepRing);
    sinceChange = 0;
    tracesLightOfNow = false;
}

bool Renderer::setSun(const glm::dvec3& directionTo, const glm::dvec3& irradiance) {
    if (!lumulus::setSun(*state_->world, directionTo, irradiance)) return false;
    state_->lightChanged();
    return true;
}

bool Renderer::setExtinction(double extinction, std::optional<std::size_t> cloud) {
    if (!lumulus::setExtinction(*state_->world, extinction, cloud)) return false;
    state_->lightChanged();
    return true;
}

void Renderer::allowSunReduction(int reduction) {
    state_->sunAllowed = reduction;
}

int Renderer::sunReduction() const {
    return shadowReduction(*state_->world);
}

bool Renderer::sharpenSun(double share) {
    return sharpenShadows(state_->work, *state_->world, share);
}

void Renderer::setOffset(const glm::dvec3& offset, std::optional<std::size_t> cloud) {
    lumulus::setOffset(*state_->world, offset, cloud);
}

bool Renderer::setWind(const glm::dvec3& velocity) {
    if (velocity == state_->world->wind) return false;
    state_->world->wind = velocity;
    return true;
}

void Renderer::setTime(double seconds) {
    const glm::dvec3 drift = seconds * state_->world->wind;
    setOffset(drift);
    for (const auto& [cloud, way] : state_->moved) setOffset(drift + way, cloud);
}

bool Renderer::moveCloud(const glm::dvec3& way, std::size_t cloud) {
    State& s = *state_;
    const auto place = s.moved.try_emplace(cloud, glm::dvec3(0.0)).first;
    if (place->second == way) return false;
    setOffset(s.world->instances.at(cloud).offset + way - place->second, cloud);
    place->second = way;
    const bool seen = s.world->visible().size() > 1 || s.ground;
    if (seen) s.lightChanged();
    return true;
}

SceneChanges Renderer::changes() const {
    return changesOf(*state_->world, state_->moved, state_->otherFog);
}

bool Renderer::take(const SceneChanges& changes) {
    bool changed = setWind(changes.wind);
    for (const auto& [cloud, way] : changes.moved) changed = moveCloud(way, cloud) || changed;
    const bool light = takeLight(*state_->world, changes);
    if (light) state_->lightChanged();
    if (changes.fog) changed = setFog(*changes.fog) || changed;  // which was made in the sun of now
    return changed || light;
}

glm::dmat4 Renderer::placementOf(std::size_t cloud) const {
    const cloud::Instance& instance = state_->world->instances.at(cloud);
    glm::dmat4 place(instance.voxelToMetres);
    place[3] = glm::dvec4(instance.origin, 1.0);
    return place;
}

query::Media Renderer::media() {
    return mediaOf(state_->context, *state_->world, stopIfInterrupted);
}

std::vector<query::CloudField> Renderer::fields() {
    return fieldsOf(state_->context, *state_->world, stopIfInterrupted);
}

Statistics Renderer::statistics() const {
    const auto& photons = state_->world->photons;
    Statistics result = finished(state_->statistics, photons ? &*photons : nullptr);
    result.validationMessages = state_->context.validationMessages();
    return result;
}

}  // namespace lumulus
