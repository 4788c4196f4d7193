#include "service/render/render_service.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/telemetry/event_log.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

const Failure shuttingDown{"shutting_down", "the service is shutting down", {}};

}  // namespace

RenderService::RenderService(const RenderConfig& config, Metrics& metrics, Outlets outlets)
    : config_(config),
      metrics_(metrics),
      outlets_(std::move(outlets)),
      scheduler_({config.limits.queuedFrames, config.limits.streams, config.limits.unsentFrames}),
      scenes_(config.limits.scenes),
      loader_(config, metrics, loaderHost()) {
    if (!config.defaultScene.empty()) {
        const SlotPointer slot = loadDefaultScene(config);
        keepSlot(slot);
        scenes_.setDefault(slot);
    }
    renderThread_ = std::thread([this] { renderLoop(); });
}

RenderService::~RenderService() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = closing_ = true;
    }
    wake_.notify_all();
    loader_.stop();
    renderThread_.join();
}

void RenderService::addClient(ClientId client) {
    const std::lock_guard lock(mutex_);
    scheduler_.addClient(client);
    scenes_.addClient(client);
}

void RenderService::removeClient(ClientId client) {
    {
        const std::lock_guard lock(mutex_);
        scheduler_.removeClient(client);
        scenes_.removeClient(client);
        loader_.removeClient(client);
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
    const bool found = scheduler_.cancel(client, cancel.request);
    if (found) outlets_.reply(client, cancel.request, Failure{"cancelled", "cancelled on request", {}});
    outlets_.reply(client, id, FrameCancelled{found});
}

void RenderService::answer(ClientId client, std::uint64_t id, Change change) {
    const SlotPointer slot = scenes_.shownTo(client);
    if (!slot) throw RequestError("no_scene", "load a scene first");
    std::optional<std::size_t> cloud;
    if (change.cloud) cloud = slot->findCloud(*change.cloud);
    changes_.push_back({slot, std::move(change.light), cloud});
    outlets_.reply(client, id, LightChanged{});
}

void RenderService::submit(ClientId client, std::uint64_t id, RenderRequest request) {
    {
        const std::lock_guard lock(mutex_);
        if (closing_) throw RequestError(shuttingDown.code, shuttingDown.text);
        const auto now = Clock::now();
        if (auto* load = std::get_if<LoadScene>(&request)) {
            loader_.submit({client, id, std::move(*load)});
            scheduler_.setWaiting(client, true);
        } else if (auto* frame = std::get_if<FrameRequest>(&request)) {
            submitFrame({client, id, workOf(std::move(*frame)), now});
        } else if (auto* composite = std::get_if<Composite>(&request)) {
            submitFrame({client, id, workOf(std::move(*composite)), now});
        } else if (auto* start = std::get_if<StartStream>(&request)) {
            scheduler_.startStream(client, id, std::move(*start), now);
        } else if (const auto* stop = std::get_if<StopStream>(&request)) {
            answer(client, id, *stop);
        } else if (const auto* cancel = std::get_if<Cancel>(&request)) {
            answer(client, id, *cancel);
        } else {
            answer(client, id, std::move(std::get<Change>(request)));
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

void RenderService::shutDown() {
    std::unique_lock lock(mutex_);
    closing_ = true;
    std::vector<SceneLoader::LoadJob> loads = loader_.close();
    std::vector<Job> failed = scheduler_.endStreams();
    for (const auto& job : loads) scheduler_.setWaiting(job.client, false);
    wake_.notify_all();
    const auto limit = std::chrono::duration<double>(config_.limits.shutdownSeconds);
    idle_.wait_for(lock, limit,
                   [this] { return !scheduler_.hasQueued() && !rendering_ && encoding_ == 0 && !loader_.busy(); });
    if (auto current = loader_.takeCurrent()) loads.push_back(std::move(*current));
    for (const std::vector<Job>& left : {scheduler_.takeQueued(), scheduler_.takeCurrent()})
        std::ranges::copy_if(left, std::back_inserter(failed), [](const Job& job) { return !job.stream; });
    const auto fails = [this](ClientId client, std::uint64_t id) {
        metrics_.add(Metrics::requestsRefused);
        outlets_.reply(client, id, shuttingDown);
    };
    for (const Job& job : failed) fails(job.client, job.id);
    for (const auto& job : loads) fails(job.client, job.id);
}

void RenderService::renderLoop() {
    while (true) {
        std::optional<Job> job;
        SlotPointer toRefine;
        bool starving = false;
        {
            std::unique_lock lock(mutex_);
            rendering_ = false;
            idle_.notify_all();
            if (stopping_) return;
            applyChanges();
            const auto now = Clock::now();
            const auto revision = [this](ClientId client) { return scenes_.revision(client); };
            const auto due = scheduler_.nextDue(revision);
            if (!closing_) toRefine = scenes_.toRefine(now, due);
            starving = toRefine && SceneStore::starves(*toRefine, now);
            const bool full = encodersFull(due, now);
            if (!starving && !full) job = scheduler_.take(now, revision);
            if (!job && !toRefine) {
                if (due && !full)
                    wake_.wait_until(lock, *due);
                else
                    wake_.wait(lock);
                continue;
            }
            rendering_ = true;
        }
        if (job)
            make(std::move(*job));
        else
            refine(toRefine, starving || !toRefine->wantsSun());
    }
}

/// With the lock held: whether nothing may be drawn until a picture is encoded. Counts each time that drawing has to
/// wait.
bool RenderService::encodersFull(std::optional<Clock::time_point> due, Clock::time_point now) {
    const bool full = encoding_ >= outlets_.mostEncoding;
    const bool waits = full && (scheduler_.hasQueued() || (due && *due <= now));
    if (waits && !waitsForEncoders_) metrics_.add(Metrics::encoderWaits);
    waitsForEncoders_ = waits;
    return full;
}

void RenderService::refine(const SlotPointer& slot, bool generation) {
    try {
        if (generation) {
            slot->traceGeneration();
            metrics_.add(Metrics::generationsTraced);
        } else {
            slot->sharpenSun();
        }
        const std::lock_guard lock(mutex_);
        scenes_.publish(*slot);
    } catch (const std::exception& e) {
        dropSlot(slot, "generation_failed", e.what());
    }
}

/// With the lock held, on the render thread: what other threads have left for the scenes.
void RenderService::applyChanges() {
    for (const auto& [slot, light, cloud] : changes_) {
        try {
            slot->apply(light, cloud);
            scenes_.publish(*slot);
        } catch (const RequestError& e) {
            logEvent("warning", "change_refused", {{"scene", slot->scene().source}, {"message", e.what()}});
        }
    }
    changes_.clear();
    for (const EncodingCost& cost : encodingCosts_)
        if (const SlotPointer slot = cost.slot.lock())
            slot->noteEncoded(cost.encoding, cost.report.milliseconds, cost.report.pixels);
    encodingCosts_.clear();
}

void RenderService::make(Job job) {
    SlotPointer slot;
    {
        const std::lock_guard lock(mutex_);
        slot = scenes_.shownTo(job.client);
    }
    try {
        if (job.cancelled->load()) throw Cancelled{};
        if (!slot) throw RequestError("no_scene", "load a scene first");
        if (const auto* composite = std::get_if<Composite>(job.work.get()))
            handOver(job, slot->composite(job, *composite), slot);
        else
            makeFrame(job, std::get<FrameRequest>(*job.work), slot);
    } catch (const RequestError& e) {
        fail(job, {e.code, e.what(), e.where});
    } catch (const Cancelled&) {
        fail(job, {"cancelled", "cancelled on request", {}});
    } catch (const std::exception& e) {
        fail(job, {"internal", e.what(), {}});
        dropSlot(slot, "frame_failed", e.what());
    }
}

void RenderService::makeFrame(Job job, const FrameRequest& frame, const SlotPointer& slot) {
    // once: of two lights that clients ask for alternately, neither would ever see all its generations
    if (!job.begun) slot->apply(frame.light);
    job.begun = true;
    bool hurry = false;
    {
        const std::lock_guard lock(mutex_);
        hurry = closing_;
    }
    if (!hurry && slot->needsGeneration(job, frame)) {
        refine(slot, true);
        bool kept = false;
        {
            const std::lock_guard lock(mutex_);
            kept = scenes_.shownTo(job.client) == slot && scheduler_.putBack(job);
        }
        if (!kept) leaveOut(job);
        return;
    }
    // a stream without a budget refines as it goes
    const bool refines = job.stream && !frame.budget.milliseconds && !frame.budget.photons && slot->wantsGeneration();
    if (refines && !hurry) refine(slot, true);
    FrameResult drawn = slot->draw(job, frame);
    {
        const std::lock_guard lock(mutex_);
        scenes_.publish(*slot);
    }
    handOver(job, std::move(drawn), slot);
}

void RenderService::leaveOut(const Job& job) {
    if (!job.stream) {
        fail(job, {"superseded", "a newer frame of the channel takes its place, or its scene is gone", {}});
        return;
    }
    const std::lock_guard lock(mutex_);
    scheduler_.leaveOut(job);
}

void RenderService::handOver(const Job& job, std::variant<FrameResult, CompositeResult> result,
                             const SlotPointer& slot) {
    {
        const std::lock_guard lock(mutex_);
        if (!scheduler_.drawn(job)) return;
        ++encoding_;
    }
    outlets_.encode({job, std::move(result), slot});
}

void RenderService::finish(const FrameTask& task, const EncodingReport& report, const std::function<void()>& send) {
    const auto* frame = std::get_if<FrameRequest>(task.job.work.get());
    {
        const std::lock_guard lock(mutex_);
        --encoding_;
        if (frame != nullptr) encodingCosts_.push_back({task.slot, frame->format.encoding, report});
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
        --encoding_;
        idle_.notify_all();
        wake_.notify_one();
        if (!scheduler_.encoded(job)) return;
        scheduler_.frameSent(job.client);  // there is none
        if (job.stream) scheduler_.stopStream(job.client, job.id);
        outlets_.reply(job.client, job.id, failure);
    }
    metrics_.add(Metrics::requestsRefused);
}

void RenderService::fail(const Job& job, const Failure& failure) {
    {
        const std::lock_guard lock(mutex_);
        if (!scheduler_.done(job)) return;
        if (job.stream) scheduler_.stopStream(job.client, job.id);
        outlets_.reply(job.client, job.id, failure);
    }
    metrics_.add(Metrics::requestsRefused);
}

/// A renderer in which something failed is of no more use; its clients have to load again.
void RenderService::dropSlot(const SlotPointer& slot, const char* event, const std::string& why) {
    if (!slot || interrupted()) return;  // the service ends
    logEvent("error", event, {{"scene", slot->scene().source}, {"message", why}});
    const std::lock_guard lock(mutex_);
    scenes_.drop(slot);
    metrics_.set(Metrics::scenesHeld, static_cast<std::int64_t>(scenes_.size()));
}

SceneLoader::Host RenderService::loaderHost() {
    SceneLoader::Host host;
    host.find = [this](const std::string& key) {
        const std::lock_guard lock(mutex_);
        return scenes_.find(key);
    };
    host.keep = [this](const SlotPointer& slot) { keepSlot(slot); };
    host.loaded = [this](const SceneLoader::LoadJob& job, const SlotPointer& slot) { loaded(job, slot); };
    host.failed = [this](const SceneLoader::LoadJob& job, const Failure& failure) { loadFailed(job, failure); };
    return host;
}

void RenderService::keepSlot(const SlotPointer& slot) {
    SlotPointer dropped;  // ends after the lock
    const std::lock_guard lock(mutex_);
    dropped = scenes_.keep(slot);
    metrics_.set(Metrics::scenesHeld, static_cast<std::int64_t>(scenes_.size()));
}

void RenderService::loaded(const SceneLoader::LoadJob& job, const SlotPointer& slot) {
    {
        const std::lock_guard lock(mutex_);
        const bool known = scenes_.knows(job.client);
        if (known && !scenes_.holds(slot)) throw RequestError("busy", "the scene has gone: load it again");
        const std::optional<bool> waits = loader_.end(job);
        idle_.notify_all();
        if (!known || !waits) return;
        scheduler_.setWaiting(job.client, *waits);
        scenes_.show(job.client, slot);
        outlets_.reply(job.client, job.id, slot->description());
    }
    wake_.notify_one();
}

void RenderService::loadFailed(const SceneLoader::LoadJob& job, const Failure& failure) {
    {
        const std::lock_guard lock(mutex_);
        const std::optional<bool> waits = loader_.end(job);
        idle_.notify_all();
        if (!waits) return;
        scheduler_.setWaiting(job.client, *waits);
        outlets_.reply(job.client, job.id, failure);
    }
    logEvent("warning", "scene_refused", {{"client", job.client}, {"code", failure.code}, {"message", failure.text}});
    wake_.notify_one();
}

}  // namespace lumulus::service
