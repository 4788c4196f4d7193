#include "service/render/scene_slot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/error.h"
#include "render/ambient.h"
#include "scene/tone.h"
#include "service/render/client_picture.h"
#include "service/render/describe_scene.h"
#include "service/render/durations.h"
#include "service/render/resample.h"
#include "service/render/scene_before.h"
#include "service/render/views.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

/// Width in pixels of the small pictures by which costs and noise of a scene are known.
constexpr int probeWidth = 96;
/// Part of a budget that a frame is planned to take: no frame costs quite what is foreseen.
constexpr double aim = 0.9;

std::string keyOf(const SceneSlot& source, ClientId owner) {
    return fmt::format("{}, light of client {}", source.key(), owner);
}

}  // namespace

SceneSlot::SceneSlot(const SourcedScene& found, const RenderConfig& config, const std::function<void()>& abandoned,
                     const std::function<void(std::string_view)>& begins, DensityCopies copies)
    : key_(found.key),
      load_(found.load),
      scene_(found.scene),
      limits_(config.limits),
      guard_(limits_.loadSeconds, abandoned, begins) {
    RendererOptions loading = options();
    loading.device = config.device;
    renderer_ = densities_->makeRenderer(scene_, loading, std::move(copies));
    scene_.sun = renderer_->sun();  // a map has one
    light_.emplace(scene_, *renderer_);
    learnCosts();
    probeNoise();
    lastTraced_ = Clock::now();
    description_ = describeScene(scene_, *renderer_, light_->now());
}

SceneSlot::SceneSlot(const std::shared_ptr<SceneSlot>& shown, ClientId owner, const EditedClouds* edited)
    : source_(shown->source_ ? shown->source_ : shown),
      key_(keyOf(*source_, owner)),
      owner_(owner),
      load_(shown->load_),
      scene_(edited != nullptr ? edited->scene : source_->scene_),
      limits_(source_->limits_),
      densities_(edited != nullptr ? shown->densities_ : source_->densities_),
      renderer_(edited != nullptr ? std::make_unique<Renderer>(scene_, *shown->renderer_, edited->origins, options())
                                  : std::make_unique<Renderer>(scene_, *source_->renderer_, options())),
      memory_(edited != nullptr ? shown->memory_ : source_->memory_),
      description_(source_->description_),
      costs_(source_->costs_),
      noise_(source_->noise_),
      revision_(shown->revision_ + 1),
      lastTraced_(Clock::now()) {
    light_.emplace(scene_, *renderer_);
    description_.light = light_->now();
    if (edited != nullptr && shown->source_) shown->dropsGeneration_ = true;  // nobody will see it
    if (edited != nullptr) mediaKeys_ = shown->mediaKeys_;
    if (edited != nullptr) tracedAt_ = shown->tracedAt_;
    if (edited != nullptr) placeAdded(scene_, *renderer_, edited->origins, shown->scene_, *shown->renderer_);
}

void SceneSlot::takePlaceOf(const std::shared_ptr<SceneSlot>& shown, ClientId owner) {
    if (renderer_->take(shown->renderer_->changes())) forgetViewed();
    mediaKeys_ = shown->mediaKeys_;
    source_ = shown->source_ ? shown->source_ : shown;
    owner_ = owner;
    key_ = keyOf(*source_, owner);
    revision_ = shown->revision_ + 1;
    while (tracedAt_.size() < static_cast<std::size_t>(renderer_->generations().count) && !shown->tracedAt_.empty())
        tracedAt_.push_front(shown->tracedAt_.front());
    if (shown->source_) shown->dropsGeneration_ = true;  // nobody will see it
    description_.originalSun = source_->description_.originalSun;
    description_.originalClouds = source_->description_.originalClouds;
    description_.light = light_->now();
}

RendererOptions SceneSlot::options() {
    RendererOptions result;
    result.keepRing = true;
    result.check = [this] { guard_.check(); };
    result.report = [this](std::string_view part, std::uint64_t, std::uint64_t) { guard_.begin(part); };
    return result;
}

void SceneSlot::onStep(const std::function<double()>& step) {
    guard_.serve([this, step] {
        const double time = time_;
        const double seconds = step();
        renderer_->setTime(time_ = time);  // pictures within have their own
        return seconds;
    });
}

bool SceneSlot::holdMemory(MemoryBudget& budget) {
    if (memory_->bytes() == 0) *memory_ = budget.open(MemoryBudget::scenes);
    return memory_->tryResize(heldBytes());
}

std::uint64_t SceneSlot::frameBytes(const FrameRequest& frame) const {
    return pictureBytes(pixelsOf(viewsOf(frame.views)));
}

SceneState SceneSlot::state() const {
    return {scene_.source,      photons(), renderer_->generationsWanted(), costs_.traceMs(), light_->now(),
            owner_.has_value(), 0};
}

void SceneSlot::apply(const LightChange& change, std::optional<std::size_t> cloud) {
    if (!light_->apply(change, cloud)) return;
    ++revision_;
    if (change.extinction) forgetViewed();
    // a generation of light that may be much work, and that nobody will see
    if (change.extinction && tracing_ > 0 && !tracesQuickly()) dropsGeneration_ = true;
}

void SceneSlot::traceGeneration() {
    const auto start = Clock::now();
    const auto pausedBefore = guard_.paused();
    const std::uint64_t lightBefore = revision_;
    dropsGeneration_ = false;
    {
        const WorkGuard::Work work(guard_, nullptr, limits_.generationSeconds, false);
        const Counted tracing(tracing_);
        CutOff cutOff;
        cutOff.due = [this] { return dropsGeneration_; };
        cutOff.roundSeconds = [this] { return guard_.stepSeconds(); };
        if (!renderer_->traceGeneration(cutOff)) return;
    }
    if (revision_ == lightBefore) light_->prove();
    costs_.traced(guard_.workedSince(start, pausedBefore));
    lastTraced_ = Clock::now();
    forgetViewed();
    tracedAt_.push_back(start);
    while (tracedAt_.size() > static_cast<std::size_t>(renderer_->generations().count)) tracedAt_.pop_front();
    ++revision_;
    probeNoise();
}

/// Share of the shadow volume that is made at a time: small enough for the pauses of a stream.
double SceneSlot::sharpenShare() const {
    constexpr double longest = 4.0, least = 1.0 / 256.0;
    const double whole = costs_.sunMs(1.0);
    return whole > longest ? std::max(least, longest / whole) : 1.0;
}

void SceneSlot::sharpenSun() {
    const auto start = Clock::now();
    const double share = sharpenShare();
    const bool whole = renderer_->sharpenSun(share);
    costs_.lit(millisecondsSince(start), share);
    lastSharpened_ = Clock::now();
    if (!whole) return;
    ++revision_;
    probeNoise();
}

/// Decides how coarse the sun's shadow volume of the next picture may be, which is foreseen to take `picture`
/// milliseconds besides. Returns the milliseconds that the shadow volume is foreseen to take in it.
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

View SceneSlot::smallView() const {
    View view = renderer_->sceneView();
    view.image.height = std::clamp(probeWidth * view.image.height / view.image.width, 1, 4 * probeWidth);
    view.image.width = probeWidth;
    return view;
}

/// Looks at the scene in small where that tells more of its noise.
void SceneSlot::probeNoise() {
    const Generations ring = renderer_->generations();
    if (!noise_.wants(ring.count) || ring.current < ring.count || renderer_->sunReduction() != 1) return;
    Looking& looking = viewer().whole;
    const Counted drawing(drawing_);
    noise_.add(renderer_->draw(smallView(), looking.state), ring.count, ring.photons());
    looking.viewed.drawn({smallView()}, renderer_->bounds(), 0.0);
}

/// Draws a small picture twice, whole and reduced: the first one compiles shaders, the second one shows what pictures
/// cost.
void SceneSlot::learnCosts() {
    const std::vector<View> views{smallView()};
    for (const int reduction : {1, 2}) {
        FrameResult first, second;
        drawViews(viewer(), views, reduction, first);
        const double enlarging = drawViews(viewer(), views, reduction, second);
        noteDrawn(second, CostModel::reduced(workFor(views, 0.0), reduction, pixelsOf(views)), enlarging);
    }
}

std::vector<View> SceneSlot::viewsOf(const std::vector<ViewRequest>& requests) const {
    return service::viewsOf(requests, renderer_->sceneView(), renderer_->bounds(), limits_.requests.pixels);
}

/// What drawing the views whole has to do. `time` [s] of the wind.
CostModel::Work SceneSlot::workFor(const std::vector<View>& views, double time) const {
    const auto missing = [&](const Looking& looking) {
        return looking.viewed.missing(views, renderer_->bounds(), time);
    };
    CostModel::Work work{views.size(), missing(viewer().whole), 0, 0, missing(viewer().reduced)};
    for (const View& view : views) {
        const auto across = static_cast<std::uint64_t>(renderer_->raysAcross(view));
        work.rays += pixelsOf({view}) * across * across;
    }
    return work;
}

bool SceneSlot::needsGeneration(const Job& job, const FrameRequest& frame) const {
    if (!wantsGeneration()) return false;
    const Generations ring = renderer_->generations();
    // light of its own has no photons at first, and without any a cloud is dark; nor are there any in the first
    // generation
    if (ring.count == 0 && (source_ || tracing_ > 0) && frame.budget.photons != std::uint64_t{0}) return true;
    if (frame.budget.photons)
        return static_cast<std::uint64_t>(ring.current) * ring.photonsEach < *frame.budget.photons ||
               (ring.current == 0 && *frame.budget.photons > 0);
    if (!frame.budget.milliseconds) return !job.stream;  // a stream gets what is there
    if (tracing_ > 0) return false;                      // as does who cannot wait for the generation on its way
    const double left = *frame.budget.milliseconds - millisecondsSince(job.arrived);
    const std::vector<View> views = viewsOf(frame.views);
    CostModel::Work work = workFor(views, frame.time);
    work.lights = std::max<std::uint64_t>(1, work.lights);  // the photons' light has changed then
    double after = costs_.drawMs(work) + costs_.encodeMs(frame.format.encoding, pixelsOf(views));
    if (renderer_->sunReduction() == 0) after += costs_.sunMs(CostModel::sunShare(CostModel::sunReductions.back()));
    return costs_.traceMs() > 0.0 && costs_.traceMs() + after <= left;
}

/// Returns the milliseconds that enlarging reduced pictures took.
double SceneSlot::drawViews(Viewer& looking, const std::vector<View>& views, int reduction, FrameResult& result) {
    double enlarging = 0.0;
    for (const View& view : views) {
        const auto start = Clock::now();
        const auto pausedBefore = guard_.paused();
        const View small = reduction > 1 ? reducedView(view, reduction) : view;
        ViewResult drawn{renderer_->draw(small, looking.of(reduction).state), 0, 0};
        drawn.drawnWidth = drawn.image.width;
        drawn.drawnHeight = drawn.image.height;
        const auto whole = Clock::now();
        if (reduction > 1) drawn.image = enlarged(drawn.image, view, small);
        enlarging += millisecondsSince(whole);
        result.drawMilliseconds += guard_.workedSince(start, pausedBefore);
        for (const PassTime& pass : renderer_->statistics().passes)
            if (pass.stage != Stage::photons) result.passes.push_back(pass);
        describePicture(drawn.image, scene_, *renderer_);
        result.views.push_back(std::move(drawn));
    }
    return enlarging;
}

/// What the passes of photons took since the last frame.
std::vector<PassTime> SceneSlot::tracePasses() {
    std::vector<PassTime> since;
    for (const PassTime& pass : renderer_->statistics().passes)
        if (pass.stage == Stage::photons) {
            double& total = passTotals_[pass.name];
            if (pass.milliseconds > total) since.push_back({pass.name, pass.milliseconds - total, pass.stage});
            total = pass.milliseconds;
        }
    return since;
}

void SceneSlot::noteDrawn(const FrameResult& result, CostModel::Work work, double enlarging) {
    CostModel::Spent spent;
    double sun = 0.0;
    for (const PassTime& pass : result.passes) {
        double& part = pass.stage == Stage::light ? spent.light : pass.stage == Stage::shadowVolume ? sun : spent.rays;
        part += pass.milliseconds;
    }
    if (sun > 0.0) costs_.lit(sun, CostModel::sunShare(renderer_->sunReduction()));
    work.lights = spent.light > 0.0 ? std::max<std::uint64_t>(1, work.lights) : 0;
    spent.enlarging = enlarging;
    spent.total = result.drawMilliseconds - sun;
    costs_.drawn(work, spent);
}

SceneShown SceneSlot::shown() const {
    const PhotonState ring = photons();
    const double age = tracedAt_.empty() ? 0.0 : millisecondsSince(tracedAt_.front()) / 1e3;
    return {scene_.source,
            ring,
            age,
            noise_.relMse(ring.photons()),
            biasIsOfNow() && seenReduction_ == 1 ? bias_.value : std::nullopt,
            repeatOverrides(scene_, *renderer_, mediaKeys_)};
}

FrameResult SceneSlot::draw(const Job& job, const FrameRequest& frame) {
    const auto start = Clock::now();
    const std::vector<View> views = viewsOf(frame.views);
    const std::uint64_t pixels = pixelsOf(views);
    const CostModel::Work work = workFor(views, frame.time);
    const Encoding encoding = frame.format.encoding;
    FrameResult result;
    result.waitedMilliseconds = milliseconds(start - job.arrived);
    const std::optional<double> limit = frame.budget.milliseconds;
    const double picture = costs_.drawMs(work) + costs_.encodeMs(encoding, pixels);
    const double sun =
        allowSun(limit ? std::optional(aim * *limit - result.waitedMilliseconds) : std::nullopt, picture);
    const double spent = millisecondsSince(job.arrived) + sun;
    if (limit) result.reduction = costs_.reductionFor(aim * *limit - spent, work, pixels, encoding);

    renderer_->setTime(time_ = frame.time);
    double enlarging = 0.0;
    Viewer& looking = viewer();
    {
        const WorkGuard::Work guarded(guard_, job.cancelled.get(), limits_.generationSeconds, true);
        const Counted drawing(drawing_);
        enlarging = drawViews(looking, views, result.reduction, result);
    }
    looking.of(result.reduction).viewed.drawn(views, renderer_->bounds(), frame.time);
    noteSeen(views, result.reduction);
    countMemory();
    noteDrawn(result, CostModel::reduced(work, result.reduction, pixels), enlarging);

    std::ranges::copy(tracePasses(), std::back_inserter(result.passes));
    result.shown = shown();
    result.tone = exposures_.toneOf(scene_.image, job, result.views, hasLightOfNow(), Clock::now());
    result.background = scene_.image.background;
    result.sunReduction = std::max(1, renderer_->sunReduction());
    return result;
}

std::vector<glm::dvec3> SceneSlot::ambientAt(const glm::dvec3& point, const std::atomic<bool>* cancelled) {
    if (scene_.ground && point.y < scene_.ground->height)
        throw InputError("the point is below the ground", "y", "raise it");
    const WorkGuard::Work guarded(guard_, cancelled, limits_.generationSeconds, true);
    const Counted drawing(drawing_);
    ViewState looking;
    std::vector<glm::dvec3> values{sunIrradianceAt(*renderer_, renderer_->media(), point, [this] { guard_.check(); })};
    std::ranges::copy(lumulus::ambientAt(*renderer_, looking, point).coefficients, std::back_inserter(values));
    return values;
}

CompositeResult SceneSlot::composite(const Job& job, const Composite& composite) {
    CompositeResult result;
    result.scene = scene_.source;
    result.waitedMilliseconds = millisecondsSince(job.arrived);
    ViewRequest request;
    request.camera = composite.camera;
    request.width = composite.width;
    request.height = composite.height;
    const View view = viewsOf({request}).front();
    LayeredImage picture;
    std::vector<float> depth = readPixels(composite, picture);
    const WorkGuard::Work guarded(guard_, job.cancelled.get(), limits_.generationSeconds, true);
    const Counted drawing(drawing_);
    result.image = renderer_->throughFog(view, std::move(picture), std::move(depth));
    result.tone = scene::toneOf(scene_.image, std::array<const LayeredImage*, 1>{&result.image});
    return result;
}

}  // namespace lumulus::service
