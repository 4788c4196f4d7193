#include "service/render/scene_slot.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/protocol/encode.h"
#include "service/protocol/json_fields.h"
#include "service/render/noise.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Clock::duration inSeconds(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

void applyLimits(scene::Scene& scene, const Limits& limits) {
    scene.preparation.memoryBudget = std::min(scene.preparation.memoryBudget, limits.sceneMemory);
    scene.photonMap.memoryBudget = std::min(scene.photonMap.memoryBudget, limits.sceneMemory);
    const auto each = static_cast<std::uint64_t>(scene.photonMap.photons) /
                      static_cast<std::uint64_t>(std::max(1, scene.photonMap.generations));
    if (each > limits.photonsPerGeneration)
        throw InputError(
            fmt::format("a generation would hold {} photons, more than {}", each, limits.photonsPerGeneration),
            "photon_map.photons", "ask for more generations or fewer photons");
    const auto pixels = static_cast<std::uint64_t>(scene.image.width) * static_cast<std::uint64_t>(scene.image.height);
    if (pixels > limits.requests.pixels)
        throw InputError(fmt::format("the picture has {} pixels, more than {}", pixels, limits.requests.pixels),
                         "image.width", "make it smaller");
}

SceneSlot::SceneSlot(std::string slotKey, const scene::Scene& scene, const Config& config,
                     const std::function<void()>& abandoned)
    : key_(std::move(slotKey)), scene_(scene), loaded_(scene), limits_(config.limits), abandoned_(abandoned) {
    deadline_ = Clock::now() + inSeconds(limits_.loadSeconds);
    RendererOptions options;
    options.device = config.device;
    options.keepRing = true;
    options.check = [this] { guard(); };
    options.report = [this](std::string_view, std::uint64_t, std::uint64_t) { guard(); };
    renderer_ = std::make_unique<Renderer>(scene_, options);
    learnCosts();
    probe();
    deadline_ = Clock::time_point::max();
    abandoned_ = {};
    lastTraced_ = Clock::now();
    description_ = describe().dump();
}

SceneSlot::Guarded::Guarded(SceneSlot& slot, const std::atomic<bool>* cancelled) : slot_(slot) {
    slot_.cancelled_ = cancelled;
    slot_.deadline_ = Clock::now() + inSeconds(slot_.limits_.generationSeconds);
}

SceneSlot::Guarded::~Guarded() {
    slot_.cancelled_ = nullptr;
    slot_.deadline_ = Clock::time_point::max();
}

void SceneSlot::guard() const {
    stopIfInterrupted();
    if (abandoned_) abandoned_();
    if (cancelled_ != nullptr && cancelled_->load()) throw Cancelled{};
    if (Clock::now() > deadline_) throw TooSlow("the scene takes longer than the limits of the service allow");
}

json SceneSlot::describe() const {
    const scene::PhotonMap& map = scene_.photonMap;
    json sun{{"direction_to", {scene_.sun.directionTo.x, scene_.sun.directionTo.y, scene_.sun.directionTo.z}},
             {"irradiance", {scene_.sun.irradiance.x, scene_.sun.irradiance.y, scene_.sun.irradiance.z}}};
    json result{{"name", scene_.source},
                {"width", scene_.image.width},
                {"height", scene_.image.height},
                {"exposure", scene_.image.exposure},
                {"sun", sun},
                {"seed", map.seed},
                {"generations", renderer_->generationsWanted()},
                {"collectors", renderer_->statistics().collectors},
                {"device", renderer_->statistics().device},
                {"warnings", renderer_->statistics().warnings}};
    if (!scene_.clouds.empty()) {
        result["extinction"] = scene_.clouds[0].extinction;
        const scene::Phase& phase = scene_.clouds[0].phase;
        const bool readsG =
            phase.model == scene::PhaseModel::henyeyGreenstein || phase.model == scene::PhaseModel::schlick;
        if (readsG) result["g"] = phase.g;
    }
    const Bounds& bounds = renderer_->bounds();
    result["center"] = {bounds.centre.x, bounds.centre.y, bounds.centre.z};
    result["radius"] = bounds.radius();
    return result;
}

json SceneSlot::state() const {
    const Generations shown = renderer_->generations();
    return {{"scene", scene_.source},
            {"generations", shown.count},
            {"current_generations", shown.current},
            {"generations_wanted", renderer_->generationsWanted()},
            {"photons", shown.photons()},
            {"trace_milliseconds", costs_.traceMs()}};
}

void SceneSlot::apply(const LightChange& light) {
    bool changed = light.wind && *light.wind != wind_;
    wind_ = light.wind.value_or(wind_);
    try {
        if (light.sunDirection || light.sunIrradiance) {
            scene::Sun& sun = scene_.sun;
            const glm::dvec3 direction = light.sunDirection.value_or(sun.directionTo);
            const glm::dvec3 irradiance = light.sunIrradiance.value_or(sun.irradiance);
            changed = renderer_->setSun(direction, irradiance) || changed;
            sun.directionTo = direction;
            sun.irradiance = irradiance;
        }
        if (light.extinction) {
            changed = renderer_->setExtinction(*light.extinction) || changed;
            scene_.clouds[0].extinction = *light.extinction;
        }
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what());
    }
    if (changed) ++revision_;
}

int SceneSlot::generationsMissing() const {
    return renderer_->generationsWanted() - renderer_->generations().current;
}

void SceneSlot::traceGeneration() {
    const auto start = Clock::now();
    {
        const Guarded guarded(*this, nullptr);
        renderer_->traceGeneration();
    }
    costs_.traced(millisecondsSince(start));
    lastTraced_ = Clock::now();
    tracedAt_.push_back(start);
    while (tracedAt_.size() > static_cast<std::size_t>(renderer_->generations().count)) tracedAt_.pop_front();
    ++revision_;
    probe();
}

/// Small enough for the pauses of a stream.
double SceneSlot::sharpenShare() const {
    constexpr double milliseconds = 4.0, least = 1.0 / 256.0;
    const double whole = costs_.sunMs(1.0);
    return whole > milliseconds ? std::max(least, milliseconds / whole) : 1.0;
}

void SceneSlot::sharpenSun() {
    const auto start = Clock::now();
    const double share = sharpenShare();
    const bool whole = renderer_->sharpenSun(share);
    costs_.lit(millisecondsSince(start), share);
    lastSharpened_ = Clock::now();
    if (!whole) return;
    ++revision_;
    probe();
}

/// Decides what the next picture, foreseen to take `picture` milliseconds besides, may leave out of the sun. Returns
/// the milliseconds that the sun is foreseen to take in it.
double SceneSlot::allowSun(std::optional<double> milliseconds, double picture) {
    constexpr auto longestCoarse = std::chrono::milliseconds(100);  // between steps, whatever the deadlines
    const bool missing = renderer_->sunReduction() == 0;
    int allowed = CostModel::sunReductions.front();
    if (milliseconds && missing) {
        allowed = costs_.sunReductionFor(*milliseconds - picture);
    } else if (milliseconds && wantsSun()) {
        const double left = *milliseconds - picture;
        const bool late = left < 0.0;  // whatever is left out
        if (late || sharpenMs() <= left || Clock::now() - lastSharpened_ > longestCoarse) sharpenSun();
        allowed = CostModel::sunReductions.back();
    }
    renderer_->allowSunReduction(allowed);
    return missing ? costs_.sunMs(CostModel::sunShare(allowed)) : 0.0;
}

/// Looks at the scene in small where the number of generations has doubled: what changed since is noise.
void SceneSlot::probe() {
    const Generations shown = renderer_->generations();
    const bool first = !probe_;
    if (!first && (noise_ >= 0.0 ? shown.count < 2 * probe_->generations : shown.count <= probe_->generations)) return;
    if (shown.current < shown.count || renderer_->sunReduction() != 1) return;
    View view = renderer_->sceneView();
    view.image.height = std::clamp(probeWidth * view.image.height / view.image.width, 1, 4 * probeWidth);
    view.image.width = probeWidth;
    LayeredImage image = renderer_->draw(view);
    if (!first && probe_->generations > 0 && shown.count > probe_->generations)
        noise_ =
            nestedNoise(probe_->image, probe_->generations, image, shown.count) * static_cast<double>(shown.photons());
    probe_ = Probe{std::move(image), shown.count};
}

}  // namespace lumulus::service
