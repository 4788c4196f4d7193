#include "service/render/render_service.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

const Failure shuttingDown{"shutting_down", "the service is shutting down", {}};

/// A client's first picture is charged beforehand, by its pixels, so that those which come within others and before
/// them are small. Where the size is the scene's, nothing is foreseen.
void foresee(Scheduler& scheduler, ClientId client, const FrameRequest& frame) {
    constexpr double perPixel = 1e-4;  // milliseconds
    if (scheduler.lastCost(client) > 0.0) return;
    double pixels = 0.0;
    for (const ViewRequest& view : frame.views)
        pixels += static_cast<double>(view.width.value_or(0)) * view.height.value_or(0);
    scheduler.charge(client, perPixel * pixels);
}

}  // namespace

RenderService::RenderService(const RenderConfig& config, Instruments& instruments, Outlets outlets)
    : config_(config),
      metrics_(instruments.metrics),
      outlets_(std::move(outlets)),
      scheduler_({config.limits.queuedFrames, config.limits.streams, config.limits.unsentFrames}),
      scenes_(config.limits.scenes, config.limits.ownLights),
      encoding_(outlets_.mostEncoding),
      queries_(mutex_, outlets_.reply),
      ambient_(mutex_, scenes_, outlets_.reply),
      lights_(config, instruments, {mutex_, scenes_, [this](const SceneSlot& slot) { return step(slot); }}),
      densities_(instruments, {mutex_, scenes_, outlets_.reply, [this] { wakeAll(); },
                               [this](const SceneSlot& slot) { return step(slot); }}),
      fogs_(config, instruments, {mutex_, scenes_, lights_, outlets_.reply, [this] { wakeAll(); }}),
      bias_([this] { wakeAll(); }),
      maker_(instruments, {mutex_, scheduler_, scenes_, changes_, encoding_, desk_, lights_, densities_, fogs_,
                           closing_, outlets_.reply, outlets_.encode}),
      desk_(config, instruments, deskHost()) {
    renderThread_ = std::thread([this] { renderLoop(); });
}

SceneDesk::Host RenderService::deskHost() {
    return {mutex_,
            scheduler_,
            scenes_,
            changes_,
            densities_,
            outlets_.reply,
            [this] { wakeAll(); },
            outlets_.begun,
            [this](const SceneSlot& slot) { return step(slot); }};
}

void RenderService::wakeAll() {
    // with the lock, or the one who looks for work or idleness could miss it
    const std::lock_guard lock(mutex_);
    idle_.notify_all();
    wake_.notify_one();
}

/// On the render thread, between the steps of work on a scene. Returns the seconds of the next one.
double RenderService::step(const SceneSlot& slot) {
    heartbeat_.step();
    return maker_.interject(slot);
}

RenderService::~RenderService() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = closing_ = true;
    }
    wake_.notify_all();
    queries_.stop();
    fogs_.stop();
    desk_.stop();
    bias_.stop();
    renderThread_.join();
}

void RenderService::addClient(ClientId client) {
    const std::lock_guard lock(mutex_);
    scheduler_.addClient(client);
    scenes_.addClient(client);
    desk_.addClient(client);
}

void RenderService::removeClient(ClientId client) {
    {
        const std::lock_guard lock(mutex_);
        scheduler_.removeClient(client);
        queries_.removeClient(client);
        ambient_.removeClient(client);
        scenes_.removeClient(client);
        desk_.removeClient(client);
        densities_.removeClient(client);
        fogs_.removeClient(client);
        lights_.removeClient(client);
        metrics_.set(Metrics::streamsRunning, static_cast<std::int64_t>(scheduler_.streams()));
    }
    wake_.notify_one();
}

void RenderService::submitFrame(Job job) {
    const ClientId client = job.client;
    const std::vector<std::uint64_t> superseded = scheduler_.submit(std::move(job));
    metrics_.add(Metrics::framesSuperseded, static_cast<std::int64_t>(superseded.size()));
    for (const std::uint64_t old : superseded)
        outlets_.reply(client, old, Failure{"superseded", "a newer frame of the channel takes its place", {}});
}

void RenderService::answer(ClientId client, std::uint64_t id, const StopStream& stop) {
    outlets_.reply(client, id, StreamStopped{scheduler_.stopStream(client, stop.stream)});
}

void RenderService::answer(ClientId client, std::uint64_t id, const Cancel& cancel) {
    const bool density = changes_.cancel(client, cancel.request) || desk_.cancel(client, cancel.request);
    if (density) scenes_.breakPromise(client);
    const bool found = density || scheduler_.cancel(client, cancel.request) ||
                       queries_.cancel(client, cancel.request) || ambient_.cancel(client, cancel.request);
    if (found) outlets_.reply(client, cancel.request, Failure{"cancelled", "cancelled on request", {}});
    outlets_.reply(client, id, FrameCancelled{found});
}

void RenderService::answer(ClientId client, std::uint64_t id, Change change,
                           const std::shared_ptr<MemoryBudget::Share>& memory) {
    const SlotPointer slot = scenes_.shownTo(client);
    if (!slot && desk_.defaultPending())
        throw RequestError("busy", "the default scene is being loaded: try again later");
    if (!slot) throw RequestError("no_scene", "load a scene first");
    if (!change.media.empty()) {
        lights_.promiseFog(client, slot);
        fogs_.submit({client, id, std::move(change.media), memory});
        return;
    }
    if (!change.edits.empty() || change.density || changes_.editsOf(client)) {
        if (!change.edits.empty() || change.density) scenes_.promiseOwn(client);
        PendingChanges::Change later{client, slot, std::move(change.light), {}, true, std::move(change.edits)};
        later.named = change.cloud.has_value();
        later.reference = change.cloud.value_or(CloudReference{});
        later.request = id;
        later.density = std::move(change.density);
        changes_.add(std::move(later));
        return;
    }
    std::optional<std::size_t> cloud;
    if (change.cloud) cloud = findCloud(slot->scene(), *change.cloud);
    const bool toOwn = lights_.promise(client, slot, change.light, cloud);
    changes_.add({client, slot, std::move(change.light), cloud, toOwn, {}});
    outlets_.reply(client, id, LightChanged{});
}

void RenderService::answer(QueryJob query) {
    if (!scenes_.shownTo(query.client) && desk_.defaultPending())
        throw RequestError("busy", "the default scene is being loaded: try again later");
    if (!scenes_.shownTo(query.client)) throw RequestError("no_scene", "load a scene first");
    if (query.request.product == QueryProduct::ambient) return ambient_.submit(std::move(query));
    queries_.submit(std::move(query));
}

/// On the render thread: hands over the queries that wait, with their scenes as they are now.
void RenderService::handQueries() {
    std::vector<std::pair<QueryJob, SlotPointer>> asked;
    {
        const std::lock_guard lock(mutex_);
        for (QueryJob& job : queries_.takeAsked()) {
            SlotPointer slot = scenes_.shownTo(job.client);
            if (slot)
                asked.emplace_back(std::move(job), std::move(slot));
            else
                outlets_.reply(job.client, job.id, Failure{"no_scene", "the scene is gone: load one", {}});
        }
    }
    for (auto& [job, slot] : asked) {
        std::optional<query::Media> media;
        std::string why = "the scene cannot be asked";
        try {
            media = slot->media();
        } catch (const std::exception& e) {
            why = e.what();
        }
        const std::lock_guard lock(mutex_);
        if (media)
            queries_.hand(std::move(job), std::move(*media), slot->sunDirection());
        else
            outlets_.reply(job.client, job.id, Failure{"busy", why, {}});
    }
}

/// Begins to measure the error of what the scene shows.
void RenderService::measure(const SlotPointer& slot) {
    try {
        if (std::optional<BiasJob> job = slot->beginBias()) {
            job->slot = slot;
            bias_.hand(std::move(*job));
        }
    } catch (const std::exception&) {  // pictures go on without it
    }
}

/// Gives a scene what was found of its error.
void RenderService::keepBias() {
    const std::optional<BiasDesk::Found> found = bias_.take();
    if (!found) return;
    const SlotPointer slot = found->slot.lock();
    if (!slot || !slot->keepBias(found->revision, found->bias)) return;
    const std::lock_guard lock(mutex_);
    if (scenes_.holds(slot)) scenes_.publish(*slot);
}

void RenderService::submit(ClientId client, std::uint64_t id, RenderRequest request, MemoryBudget::Share memory) {
    const auto held = std::make_shared<MemoryBudget::Share>(std::move(memory));
    {
        const std::lock_guard lock(mutex_);
        if (closing_) throw RequestError(shuttingDown.code, shuttingDown.text);
        const auto now = Clock::now();
        if (auto* load = std::get_if<LoadScene>(&request)) {
            desk_.submit({client, id, std::move(*load), held});
            fogs_.giveUp(client);
        } else if (auto* frame = std::get_if<FrameRequest>(&request)) {
            lights_.promise(client, scenes_.shownTo(client), frame->light, std::nullopt);
            foresee(scheduler_, client, *frame);
            submitFrame({client, id, workOf(std::move(*frame)), held, now});
        } else if (auto* composite = std::get_if<Composite>(&request)) {
            submitFrame({client, id, workOf(std::move(*composite)), held, now});
        } else if (auto* start = std::get_if<StartStream>(&request)) {
            lights_.promise(client, scenes_.shownTo(client), start->frame.light, std::nullopt);
            foresee(scheduler_, client, start->frame);
            scheduler_.startStream(client, id, std::move(*start), now);
        } else if (const auto* stop = std::get_if<StopStream>(&request)) {
            answer(client, id, *stop);
        } else if (const auto* cancel = std::get_if<Cancel>(&request)) {
            answer(client, id, *cancel);
        } else if (auto* query = std::get_if<QueryRequest>(&request)) {
            answer(QueryJob{client, id, std::move(*query), held});
        } else {
            answer(client, id, std::move(std::get<Change>(request)), held);
        }
        metrics_.set(Metrics::streamsRunning, static_cast<std::int64_t>(scheduler_.streams()));
    }
    wake_.notify_one();
}

void RenderService::frameSent(ClientId client) {
    {
        const std::lock_guard lock(mutex_);
        scheduler_.frameSent(client);
    }
    wake_.notify_one();
}

std::optional<SceneState> RenderService::sceneState(ClientId client) {
    const std::lock_guard lock(mutex_);
    return scenes_.state(client);
}

std::optional<std::string> RenderService::notReady() {
    if (!alive()) return "the render thread does not move";
    const std::lock_guard lock(mutex_);
    if (closing_) return "the service is shutting down";
    if (desk_.defaultPending()) return "the default scene is being loaded";
    if (!config_.defaultScene.empty() && !scenes_.hasDefault()) return "the default scene is gone";
    return std::nullopt;
}

bool RenderService::alive() const {
    return heartbeat_.silentSeconds(Clock::now()) <= config_.limits.heartbeatSeconds;
}

void RenderService::shutDown() {
    constexpr double shareOfWork = 0.8;  // of the time; the rest is for replies to leave
    std::unique_lock lock(mutex_);
    closing_ = true;
    std::vector<LoadJob> loads = desk_.close();
    std::vector<Job> failed = scheduler_.endStreams();
    wake_.notify_all();
    const auto limit = std::chrono::duration<double>(shareOfWork * config_.limits.shutdownSeconds);
    idle_.wait_for(lock, limit,
                   [this] { return !scheduler_.hasQueued() && !rendering_ && encoding_.empty() && !desk_.busy(); });
    for (LoadJob& current : desk_.takeCurrent()) loads.push_back(std::move(current));
    for (LoadJob& ready : densities_.takeAll()) loads.push_back(std::move(ready));
    for (const std::vector<Job>& left : {scheduler_.takeQueued(), scheduler_.takeCurrent()})
        std::ranges::copy_if(left, std::back_inserter(failed), [](const Job& job) { return !job.stream; });
    const auto fails = [this](ClientId client, std::uint64_t id) {
        metrics_.add(Metrics::requestsRefused);
        outlets_.reply(client, id, shuttingDown);
    };
    for (const Job& job : failed) fails(job.client, job.id);
    for (const auto& job : loads) fails(job.client, job.id);
    for (const QueryJob& job : queries_.takeAll()) fails(job.client, job.id);
    for (const QueryJob& job : ambient_.takeAll()) fails(job.client, job.id);
    for (const FogDesk::Asked& asked : fogs_.takeAll()) fails(asked.client, asked.id);
}

void RenderService::renderLoop() {
    while (true) {
        std::optional<Job> job;
        SlotPointer toRefine;
        bool starving = false, ambient = false;
        heartbeat_.step();
        maker_.applyChanges();
        handQueries();
        keepBias();
        SlotPointer toMeasure;
        std::vector<SlotPointer> retired;  // end after the lock
        {
            std::unique_lock lock(mutex_);
            retired = scenes_.takeRetired();
            if (!retired.empty()) continue;
            rendering_ = false;
            idle_.notify_all();
            if (stopping_) return;
            if (changes_.any() || queries_.anyAsked() || densities_.any() || fogs_.any())
                continue;  // a picture that was asked for after a change shows it
            const auto now = Clock::now();
            const auto revision = [this](ClientId client) { return scenes_.revision(client); };
            const auto due = scheduler_.nextDue(now, revision);
            if (!closing_) toRefine = scenes_.toRefine(now, due);
            starving = toRefine && SceneStore::starves(*toRefine, now);
            const bool full = encoding_.full();
            if (encoding_.beginsToWait(scheduler_.hasQueued() || (due && *due <= now)))
                metrics_.add(Metrics::encoderWaits);
            if (!starving && !full && !ambient_.presses(now)) job = scheduler_.take(now, revision);
            ambient = !job && !starving && ambient_.any();
            if (!job && !toRefine && !ambient) {
                const auto [rests, when] =
                    bias_.isFree() && !closing_ ? scenes_.toMeasure() : std::pair(SlotPointer(), now);
                const bool waits = due && !full;
                if (rests && when <= now) {
                    toMeasure = rests;
                } else {
                    heartbeat_.rest();
                    if (waits || rests)
                        wake_.wait_until(lock, waits && rests ? std::min(*due, when) : waits ? *due : when);
                    else
                        wake_.wait(lock);
                    continue;
                }
            }
            rendering_ = true;
        }
        if (job)
            maker_.make(std::move(*job));
        else if (ambient)
            ambient_.step();
        else if (toMeasure)
            measure(toMeasure);
        else
            maker_.refine(toRefine, starving || !toRefine->wantsSun());
    }
}

void RenderService::finish(const FrameTask& task, const EncodingReport& report, const std::function<void()>& send) {
    const auto* frame = std::get_if<FrameRequest>(task.job.work.get());
    {
        const std::lock_guard lock(mutex_);
        encoding_.end();
        if (frame != nullptr) encoding_.note({task.slot, frame->format.encoding, report});
        idle_.notify_all();
        wake_.notify_one();
        if (!scheduler_.encoded(task.job)) return;
        send();
    }
    metrics_.add(Metrics::framesSent);
    metrics_.frameLatency(report.totalMilliseconds / 1e3);
    if (frame == nullptr) return;
    const std::optional<double> limit = frame->budget.milliseconds;
    metrics_.add(Metrics::framesReduced, std::get<FrameResult>(task.result).reduction > 1 ? 1 : 0);
    metrics_.add(Metrics::deadlinesMissed, limit && report.totalMilliseconds > *limit ? 1 : 0);
}

void RenderService::failEncoding(const FrameTask& task, const Failure& failure) {
    const Job& job = task.job;
    {
        const std::lock_guard lock(mutex_);
        encoding_.end();
        idle_.notify_all();
        wake_.notify_one();
        if (!scheduler_.encoded(job)) return;
        scheduler_.frameSent(job.client);  // there is none
        if (job.stream) scheduler_.stopStream(job.client, job.id);
        outlets_.reply(job.client, job.id, failure);
    }
    metrics_.add(Metrics::requestsRefused);
}

}  // namespace lumulus::service
