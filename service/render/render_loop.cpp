// The thread that draws, and refines photons while nobody asks.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/protocol/json_fields.h"
#include "service/protocol/session.h"
#include "service/render/render_service.h"
#include "service/telemetry/event_log.h"

namespace lumulus::service {

namespace {

/// However busy streams keep the service, its photons get a generation this often.
constexpr auto longestWithoutGeneration = std::chrono::seconds(1);

bool starves(const SceneSlot& slot, Clock::time_point now) {
    return slot.wantsGeneration() && now - slot.lastTraced() > longestWithoutGeneration;
}

}  // namespace

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
            const auto revision = [this](ClientId client) { return revisionOf(client); };
            const auto due = scheduler_.nextDue(revision);
            if (!closing_) toRefine = slotToRefine(now, due ? std::max(*due, now) : due);
            starving = toRefine && starves(*toRefine, now);
            if (!starving) job = scheduler_.take(now, revision);
            if (!job && !toRefine) {
                if (due)
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

/// A slot in use whose ring is not full or whose sun is coarse, if there is time for a step before the next picture is
/// due.
RenderService::SlotPointer RenderService::slotToRefine(Clock::time_point now, std::optional<Clock::time_point> due) {
    SlotPointer best;
    for (const SlotPointer& slot : slots_) {
        const bool used = slot == defaultSlot_ ||
                          std::ranges::any_of(slotOfClient_, [&](const auto& entry) { return entry.second == slot; });
        if (used && (slot->wantsGeneration() || slot->wantsSun()) && (!best || slot->lastTraced() < best->lastTraced()))
            best = slot;
    }
    if (!best || !due || starves(*best, now)) return best;
    const double step = best->wantsSun() ? best->sharpenMs() : best->traceMs();
    const auto cost = std::chrono::duration<double, std::milli>(step);
    return now + cost < *due ? best : nullptr;
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
        publish(*slot);
    } catch (const std::exception& e) {
        dropSlot(slot, "generation_failed", e.what());
    }
}

/// For the other threads, with the lock held.
void RenderService::publish(const SceneSlot& slot) {
    revisions_[slot.key()] = slot.revision();
    states_[slot.key()] = slot.state().dump();
}

/// With the lock held.
void RenderService::applyChanges() {
    for (const auto& [slot, light] : changes_) {
        try {
            slot->apply(light);
            publish(*slot);
        } catch (const RequestError& e) {
            logEvent("warning", "change_refused", {{"scene", slot->scene().source}, {"message", e.what()}});
        }
    }
    changes_.clear();
}

std::uint64_t RenderService::revisionOf(ClientId client) const {
    const auto it = slotOfClient_.find(client);
    if (it == slotOfClient_.end() || !it->second) return 0;
    const auto revision = revisions_.find(it->second->key());
    return revision == revisions_.end() ? 0 : revision->second;
}

RenderService::SlotPointer RenderService::slotOf(ClientId client) {
    const std::lock_guard lock(mutex_);
    const auto it = slotOfClient_.find(client);
    return it == slotOfClient_.end() ? nullptr : it->second;
}

void RenderService::make(Job job) {
    const SlotPointer slot = slotOf(job.client);
    try {
        if (job.cancelled->load()) throw Cancelled{};
        if (!slot) throw RequestError("no_scene", "load a scene first");
        if (const auto* composite = std::get_if<Composite>(job.work.get()))
            handOver(job, slot->composite(job, *composite));
        else
            makeFrame(job, std::get<FrameRequest>(*job.work), slot);
        return;
    } catch (const RequestError& e) {
        fail(job, e.code, e.what(), e.where);
    } catch (const Cancelled&) {
        fail(job, "cancelled", "cancelled on request");
    } catch (const std::exception& e) {
        fail(job, "internal", e.what());
        dropSlot(slot, "frame_failed", e.what());
    }
}

void RenderService::makeFrame(Job job, const FrameRequest& frame, const SlotPointer& slot) {
    // once: of two lights that clients ask for in turns, neither would ever see all its generations
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
            kept =
                slotOfClient_.contains(job.client) && slotOfClient_.at(job.client) == slot && scheduler_.putBack(job);
        }
        if (!kept) leaveOut(job);
        return;
    }
    // a stream without a budget refines as it goes
    const bool refines = job.stream && !frame.budget.milliseconds && !frame.budget.photons && slot->wantsGeneration();
    if (refines && !hurry) refine(slot, true);
    SceneSlot::Frame made = slot->draw(job, frame);
    {
        const std::lock_guard lock(mutex_);
        publish(*slot);
    }
    handOver(job, std::move(made));
}

void RenderService::leaveOut(const Job& job) {
    if (!job.stream) {
        fail(job, "superseded", "a newer frame of the channel takes its place, or its scene is gone");
        return;
    }
    const std::lock_guard lock(mutex_);
    scheduler_.leaveOut(job);
}

void RenderService::handOver(const Job& job, SceneSlot::Frame frame) {
    {
        const std::lock_guard lock(mutex_);
        if (!scheduler_.done(job)) return;
        scheduler_.frameHandedOver(job.client);
        deliver_(job.client, std::move(frame.reply), true);
    }
    metrics_.add(Metrics::framesSent);
    metrics_.add(Metrics::framesReduced, frame.reduced ? 1 : 0);
    metrics_.add(Metrics::deadlinesMissed, frame.late ? 1 : 0);
    metrics_.frameLatency(frame.seconds);
}

void RenderService::fail(const Job& job, const std::string& code, const std::string& text, const std::string& where) {
    {
        const std::lock_guard lock(mutex_);
        if (!scheduler_.done(job)) return;
        if (job.stream) scheduler_.stopStream(job.client, job.id);
        deliver_(job.client, errorReply(job.id, code, text, where), false);
    }
    metrics_.add(Metrics::requestsRefused);
}

/// A renderer in which something failed is of no more use; its clients have to load again.
void RenderService::dropSlot(const SlotPointer& slot, const char* event, const std::string& why) {
    if (!slot || interrupted()) return;  // the service ends
    logEvent("error", event, {{"scene", slot->scene().source}, {"message", why}});
    const std::lock_guard lock(mutex_);
    std::erase(slots_, slot);
    states_.erase(slot->key());
    revisions_.erase(slot->key());
    for (auto& [client, used] : slotOfClient_)
        if (used == slot) used = nullptr;
    if (defaultSlot_ == slot) defaultSlot_ = nullptr;
    metrics_.set(Metrics::scenesHeld, static_cast<std::int64_t>(slots_.size()));
}

}  // namespace lumulus::service
