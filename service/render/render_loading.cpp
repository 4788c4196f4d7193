// The thread that loads scenes, and which of them stay in memory.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/protocol/json_fields.h"
#include "service/protocol/session.h"
#include "service/render/render_service.h"
#include "service/render/scene_source.h"
#include "service/telemetry/event_log.h"

namespace lumulus::service {

using nlohmann::json;

void RenderService::loadLoop() {
    while (true) {
        LoadJob job;
        {
            std::unique_lock lock(mutex_);
            loading_.reset();
            idle_.notify_all();
            loadWake_.wait(lock, [this] { return stopping_ || (!closing_ && !loads_.empty()); });
            if (stopping_) return;
            job = std::move(loads_.front());
            loads_.pop_front();
            loading_ = job;
            abandon_ = false;
        }
        load(job);
    }
}

void RenderService::load(const LoadJob& job) {
    const auto start = Clock::now();
    try {
        const SourcedScene found = sourceScene(job.load, config_, job.client);
        SlotPointer slot = findSlot(found.key);
        if (!slot) {
            logEvent("info", "scene_loading", {{"client", job.client}, {"scene", found.scene.source}});
            slot = std::make_shared<SceneSlot>(found.key, found.scene, config_, [this] {
                if (abandon_) throw Cancelled{};
            });
            keepSlot(slot);
            metrics_.add(Metrics::scenesLoaded);
            logEvent("info", "scene_loaded",
                     {{"client", job.client},
                      {"scene", found.scene.source},
                      {"seconds", std::chrono::duration<double>(Clock::now() - start).count()}});
        }
        finishLoad(job, slot);
    } catch (const RequestError& e) {
        failLoad(job, e.code, e.what(), e.where);
    } catch (const Cancelled&) {
        failLoad(job, "shutting_down", "the service is shutting down");  // or its client is gone
    } catch (const TooSlow& e) {
        failLoad(job, "too_large", e.what());
    } catch (const InputError& e) {
        failLoad(job, "bad_request", e.what());
    } catch (const std::bad_alloc&) {
        failLoad(job, "too_large", "the scene does not fit into memory");
    } catch (const std::exception& e) {
        failLoad(job, "internal", e.what());
    }
}

RenderService::SlotPointer RenderService::findSlot(const std::string& key) {
    const std::lock_guard lock(mutex_);
    const auto it = std::ranges::find_if(slots_, [&](const SlotPointer& slot) { return slot->key() == key; });
    return it == slots_.end() ? nullptr : *it;
}

/// Publishes a slot; the oldest that nobody uses goes where there are too many. Errors: RequestError `busy`.
void RenderService::keepSlot(const SlotPointer& slot) {
    SlotPointer dropped;  // dies after the lock: a renderer takes its time
    const std::lock_guard lock(mutex_);
    if (slots_.size() >= config_.limits.scenes) {
        const auto used = [this](const SlotPointer& one) {
            return one == defaultSlot_ ||
                   std::ranges::any_of(slotOfClient_, [&](const auto& entry) { return entry.second == one; });
        };
        const auto unused = std::ranges::find_if_not(slots_, used);
        if (unused == slots_.end())
            throw RequestError(
                "busy", "all " + std::to_string(config_.limits.scenes) + " scenes that the service holds are in use");
        states_.erase((*unused)->key());
        revisions_.erase((*unused)->key());
        dropped = *unused;
        slots_.erase(unused);
    }
    slots_.push_back(slot);
    publish(*slot);
    metrics_.set(Metrics::scenesHeld, static_cast<std::int64_t>(slots_.size()));
}

/// With the lock held: its client waits no more, unless for another. False where the load was answered already.
bool RenderService::endLoad(const LoadJob& job) {
    if (!loading_) return false;
    loading_.reset();
    scheduler_.setWaiting(job.client, std::ranges::count(loads_, job.client, &LoadJob::client) > 0);
    return true;
}

void RenderService::finishLoad(const LoadJob& job, const SlotPointer& slot) {
    {
        const std::lock_guard lock(mutex_);
        if (!slotOfClient_.contains(job.client)) return;
        if (std::ranges::count(slots_, slot) == 0) throw RequestError("busy", "the scene has gone: load it again");
        if (!endLoad(job)) return;
        slotOfClient_[job.client] = slot;
        deliver_(job.client, {replyTo(MessageType::loadScene), job.id, slot->description(), {}}, false);
    }
    wake_.notify_one();
}

void RenderService::failLoad(const LoadJob& job, const std::string& code, const std::string& text,
                             const std::string& where) {
    {
        const std::lock_guard lock(mutex_);
        if (!endLoad(job)) return;
        deliver_(job.client, errorReply(job.id, code, text, where), false);
    }
    logEvent("warning", "scene_refused", {{"client", job.client}, {"code", code}, {"message", text}});
    wake_.notify_one();
}

}  // namespace lumulus::service
