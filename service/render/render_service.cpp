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
constexpr const char* noMemory = "there is no memory for so many pixels now: ask for fewer, or later";

}  // namespace

RenderService::RenderService(const RenderConfig& config, Instruments& instruments, Outlets outlets)
    : config_(config),
      metrics_(instruments.metrics),
      log_(instruments.log),
      memory_(instruments.memory),
      outlets_(std::move(outlets)),
      scheduler_({config.limits.queuedFrames, config.limits.streams, config.limits.unsentFrames}),
      scenes_(config.limits.scenes),
      encoding_(outlets_.mostEncoding),
      desk_(config, instruments, deskHost()) {
    renderThread_ = std::thread([this] { renderLoop(); });
}

SceneDesk::Host RenderService::deskHost() {
    return {mutex_,
            scheduler_,
            scenes_,
            changes_,
            outlets_.reply,
            [this] {
                // with the lock, or the one who looks for work or idleness could miss it
                const std::lock_guard lock(mutex_);
                idle_.notify_all();
                wake_.notify_one();
            },
            outlets_.begun,
            [this] { heartbeat_.step(); }};
}

RenderService::~RenderService() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = closing_ = true;
    }
    wake_.notify_all();
    desk_.stop();
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
        scenes_.removeClient(client);
        desk_.removeClient(client);
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
    if (!slot && desk_.defaultPending())
        throw RequestError("busy", "the default scene is being loaded: try again later");
    if (!slot) throw RequestError("no_scene", "load a scene first");
    std::optional<std::size_t> cloud;
    if (change.cloud) cloud = slot->findCloud(*change.cloud);
    changes_.add({slot, std::move(change.light), cloud});
    outlets_.reply(client, id, LightChanged{});
}

void RenderService::submit(ClientId client, std::uint64_t id, RenderRequest request, MemoryBudget::Share memory) {
    const auto held = std::make_shared<MemoryBudget::Share>(std::move(memory));
    {
        const std::lock_guard lock(mutex_);
        if (closing_) throw RequestError(shuttingDown.code, shuttingDown.text);
        const auto now = Clock::now();
        if (auto* load = std::get_if<LoadScene>(&request)) {
            desk_.submit({client, id, std::move(*load), held});
        } else if (auto* frame = std::get_if<FrameRequest>(&request)) {
            submitFrame({client, id, workOf(std::move(*frame)), held, now});
        } else if (auto* composite = std::get_if<Composite>(&request)) {
            submitFrame({client, id, workOf(std::move(*composite)), held, now});
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
    std::vector<SceneLoader::LoadJob> loads = desk_.close();
    std::vector<Job> failed = scheduler_.endStreams();
    wake_.notify_all();
    const auto limit = std::chrono::duration<double>(shareOfWork * config_.limits.shutdownSeconds);
    idle_.wait_for(lock, limit,
                   [this] { return !scheduler_.hasQueued() && !rendering_ && encoding_.empty() && !desk_.busy(); });
    if (auto current = desk_.takeCurrent()) loads.push_back(std::move(*current));
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
        heartbeat_.step();
        applyChanges();
        {
            std::unique_lock lock(mutex_);
            rendering_ = false;
            idle_.notify_all();
            if (stopping_) return;
            if (changes_.any()) continue;  // a picture that was asked for after a change shows it
            const auto now = Clock::now();
            const auto revision = [this](ClientId client) { return scenes_.revision(client); };
            const auto due = scheduler_.nextDue(revision);
            if (!closing_) toRefine = scenes_.toRefine(now, due);
            starving = toRefine && SceneStore::starves(*toRefine, now);
            const bool full = encoding_.full();
            if (encoding_.beginsToWait(scheduler_.hasQueued() || (due && *due <= now)))
                metrics_.add(Metrics::encoderWaits);
            if (!starving && !full) job = scheduler_.take(now, revision);
            if (!job && !toRefine) {
                heartbeat_.rest();
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

/// On the render thread, without the lock: changes take their time.
void RenderService::applyChanges() {
    std::vector<PendingChanges::Change> changes;
    std::vector<EncodingDesk::Cost> costs;
    {
        const std::lock_guard lock(mutex_);
        changes = changes_.takeAll();
        costs = encoding_.takeCosts();
    }
    for (const auto& [slot, light, cloud] : changes) {
        try {
            slot->apply(light, cloud);
            const std::lock_guard lock(mutex_);
            scenes_.publish(*slot);
        } catch (const RequestError& e) {
            log_.event("warning", "change_refused", {{"scene", slot->scene().source}, {"message", e.what()}});
        }
    }
    for (const EncodingDesk::Cost& cost : costs)
        if (const SlotPointer slot = cost.slot.lock())
            slot->noteEncoded(cost.encoding, cost.report.milliseconds, cost.report.pixels);
}

/// Errors: RequestError where the budget does not have it.
MemoryBudget::Share RenderService::roomFor(std::uint64_t bytes) {
    auto share = memory_.take(MemoryBudget::frames, bytes);
    if (!share) throw RequestError("busy", noMemory);
    return std::move(*share);
}

void RenderService::make(Job job) {
    SlotPointer slot;
    bool closing = false;
    {
        const std::lock_guard lock(mutex_);
        slot = scenes_.shownTo(job.client);
        closing = closing_;
    }
    try {
        if (job.cancelled->load()) throw Cancelled{};
        if (!slot && closing) throw RequestError(shuttingDown.code, shuttingDown.text);
        if (!slot) throw RequestError("no_scene", "load a scene first");
        if (const auto* composite = std::get_if<Composite>(job.work.get())) {
            MemoryBudget::Share memory = roomFor(SceneSlot::pictureBytes(composite->pixels.size() / 16));
            handOver(job, slot->composite(job, *composite), slot, std::move(memory));
        } else
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
    auto memory = memory_.take(MemoryBudget::frames, slot->frameBytes(frame));
    if (!memory && job.stream) return leaveOut(job);
    if (!memory) throw RequestError("busy", noMemory);
    FrameResult drawn = slot->draw(job, frame);
    {
        const std::lock_guard lock(mutex_);
        scenes_.publish(*slot);
    }
    handOver(job, std::move(drawn), slot, std::move(*memory));
}

void RenderService::leaveOut(const Job& job) {
    if (!job.stream) {
        fail(job, {"superseded", "a newer frame of the channel takes its place, or its scene is gone", {}});
        return;
    }
    const std::lock_guard lock(mutex_);
    scheduler_.leaveOut(job);
}

void RenderService::handOver(const Job& job, std::variant<FrameResult, CompositeResult> result, const SlotPointer& slot,
                             MemoryBudget::Share memory) {
    {
        const std::lock_guard lock(mutex_);
        if (!scheduler_.drawn(job)) return;
        encoding_.begin();
    }
    outlets_.encode({job, std::move(result), slot, std::move(memory)});
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
    log_.event("error", event, {{"scene", slot->scene().source}, {"message", why}});
    const std::lock_guard lock(mutex_);
    scenes_.drop(slot);
    metrics_.set(Metrics::scenesHeld, static_cast<std::int64_t>(scenes_.size()));
}

}  // namespace lumulus::service
