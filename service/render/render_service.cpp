#include "service/render/render_service.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "service/protocol/json_fields.h"
#include "service/protocol/session.h"
#include "service/render/scene_source.h"
#include "service/telemetry/event_log.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

Scheduler::Bounds boundsOf(const Limits& limits) {
    return {limits.queuedFrames, limits.streams, limits.unsentFrames};
}

std::optional<scene::Quality> qualityOf(const std::string& name) {
    if (name.empty()) return std::nullopt;
    return name == "draft" ? scene::Quality::draft
                           : (name == "final" ? scene::Quality::final : scene::Quality::interactive);
}

}  // namespace

RenderService::RenderService(const Config& config, Metrics& metrics, Deliver deliver)
    : config_(config), metrics_(metrics), deliver_(std::move(deliver)), scheduler_(boundsOf(config.limits)) {
    if (!config.defaultScene.empty()) {
        LoadScene load;
        load.name = config.defaultScene;
        load.quality = qualityOf(config.quality);
        try {
            SourcedScene found = sourceScene(load, config, 0);
            logEvent("info", "scene_loading", {{"scene", found.scene.source}});
            defaultSlot_ = std::make_shared<SceneSlot>(found.key, found.scene, config, std::function<void()>());
        } catch (const std::runtime_error& e) {
            throw InputError(std::string("the default scene: ") + e.what(), config.defaultScene,
                             "change scenes.default");
        }
        keepSlot(defaultSlot_);
    }
    renderThread_ = std::thread([this] { renderLoop(); });
    loadThread_ = std::thread([this] { loadLoop(); });
}

RenderService::~RenderService() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = closing_ = true;
    }
    abandon_ = true;
    wake_.notify_all();
    loadWake_.notify_all();
    renderThread_.join();
    loadThread_.join();
}

void RenderService::addClient(ClientId client) {
    const std::lock_guard lock(mutex_);
    scheduler_.addClient(client);
    slotOfClient_[client] = defaultSlot_;
}

void RenderService::removeClient(ClientId client) {
    {
        const std::lock_guard lock(mutex_);
        scheduler_.removeClient(client);
        slotOfClient_.erase(client);
        std::erase_if(loads_, [&](const LoadJob& job) { return job.client == client; });
        if (loading_ && loading_->client == client) abandon_ = true;
        metrics_.set(Metrics::streamsRunning, static_cast<std::int64_t>(scheduler_.streams()));
    }
    wake_.notify_one();
}

void RenderService::submit(ClientId client, std::uint64_t id, Request request) {
    std::vector<std::uint64_t> superseded;
    std::vector<Message> replies;
    {
        const std::lock_guard lock(mutex_);
        if (closing_) throw RequestError("shutting_down", "the service is shutting down");
        const auto now = Clock::now();
        if (auto* load = std::get_if<LoadScene>(&request)) {
            if (std::ranges::count(loads_, client, &LoadJob::client) >= 4)
                throw RequestError("busy", "four scenes wait to be loaded already");
            loads_.push_back({client, id, std::move(*load)});
            scheduler_.setWaiting(client, true);
        } else if (auto* frame = std::get_if<FrameRequest>(&request)) {
            superseded = scheduler_.submit({client, id, workOf(std::move(*frame)), now});
        } else if (auto* composite = std::get_if<Composite>(&request)) {
            scheduler_.submit({client, id, workOf(std::move(*composite)), now});
        } else if (auto* start = std::get_if<StartStream>(&request)) {
            scheduler_.startStream(client, id, std::move(*start), now);
        } else if (const auto* stop = std::get_if<StopStream>(&request)) {
            const bool found = scheduler_.stopStream(client, stop->stream);
            replies.push_back({replyTo(MessageType::stopStream), id, json{{"found", found}}.dump(), {}});
        } else if (const auto* cancel = std::get_if<Cancel>(&request)) {
            const bool found = scheduler_.cancel(client, cancel->request);
            if (found) replies.push_back(errorReply(cancel->request, "cancelled", "cancelled on request"));
            replies.push_back({replyTo(MessageType::cancel), id, json{{"found", found}}.dump(), {}});
        } else if (auto* change = std::get_if<Change>(&request)) {
            const SlotPointer slot = slotOfClient_.at(client);
            if (!slot) throw RequestError("no_scene", "load a scene first");
            changes_.emplace_back(slot, std::move(change->light));
            replies.push_back({replyTo(MessageType::change), id, "{}", {}});
        }
        metrics_.set(Metrics::streamsRunning, static_cast<std::int64_t>(scheduler_.streams()));
        metrics_.add(Metrics::framesSuperseded, static_cast<std::int64_t>(superseded.size()));
        for (const std::uint64_t old : superseded)
            deliver_(client, errorReply(old, "superseded", "a newer frame of the channel takes its place"), false);
        for (Message& reply : replies) deliver_(client, std::move(reply), false);
    }
    wake_.notify_one();
    loadWake_.notify_one();
}

void RenderService::frameSent(ClientId client) {
    {
        const std::lock_guard lock(mutex_);
        scheduler_.frameSent(client);
    }
    wake_.notify_one();
}

json RenderService::statistics(ClientId client) {
    json result = json::parse(metrics_.json());
    const std::lock_guard lock(mutex_);
    const auto it = slotOfClient_.find(client);
    if (it != slotOfClient_.end() && it->second) {
        const auto state = states_.find(it->second->key());
        if (state != states_.end()) result["scene"] = json::parse(state->second);
    }
    return result;
}

void RenderService::shutDown() {
    std::unique_lock lock(mutex_);
    closing_ = true;
    abandon_ = true;
    std::deque<LoadJob> loads = std::exchange(loads_, {});
    std::vector<Job> failed = scheduler_.endStreams();
    for (const LoadJob& job : loads) scheduler_.setWaiting(job.client, false);
    wake_.notify_all();
    const auto limit = std::chrono::duration<double>(config_.limits.shutdownSeconds);
    idle_.wait_for(lock, limit, [this] { return !scheduler_.hasQueued() && !rendering_ && !loading_; });
    if (loading_) loads.push_back(*std::exchange(loading_, std::nullopt));
    for (const std::vector<Job>& left : {scheduler_.takeQueued(), scheduler_.takeCurrent()})
        std::ranges::copy_if(left, std::back_inserter(failed), [](const Job& job) { return !job.stream; });
    const auto fails = [this](ClientId client, std::uint64_t id) {
        metrics_.add(Metrics::requestsRefused);
        deliver_(client, errorReply(id, "shutting_down", "the service is shutting down"), false);
    };
    for (const Job& job : failed) fails(job.client, job.id);
    for (const LoadJob& job : loads) fails(job.client, job.id);
}

}  // namespace lumulus::service
