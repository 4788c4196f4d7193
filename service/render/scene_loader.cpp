#include "service/render/scene_loader.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "service/render/scene_source.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::ptrdiff_t mostWaiting = 4;  // of one client

}  // namespace

SceneLoader::SceneLoader(const RenderConfig& config, Instruments& instruments, Host host)
    : config_(config), instruments_(instruments), host_(std::move(host)), thread_([this] { loop(); }) {}

SceneLoader::~SceneLoader() {
    stop();
}

void SceneLoader::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = closed_ = true;
    }
    abandon_ = true;
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void SceneLoader::submit(LoadJob job) {
    {
        const std::lock_guard lock(mutex_);
        if (std::ranges::count(queue_, job.client, &LoadJob::client) >= mostWaiting)
            throw RequestError("busy", "four scenes wait to be loaded already");
        queue_.push_back(std::move(job));
    }
    wake_.notify_all();
}

void SceneLoader::removeClient(ClientId client) {
    const std::lock_guard lock(mutex_);
    std::erase_if(queue_, [&](const LoadJob& job) { return job.client == client; });
    if (loading_ && loading_->client == client) abandon_ = true;
}

bool SceneLoader::waits(ClientId client) const {
    return std::ranges::count(queue_, client, &LoadJob::client) > 0;
}

std::optional<bool> SceneLoader::end(const LoadJob& job) {
    const std::lock_guard lock(mutex_);
    if (!loading_) return std::nullopt;
    loading_.reset();
    return waits(job.client);
}

bool SceneLoader::worksFor(ClientId client) const {
    const std::lock_guard lock(mutex_);
    return waits(client) || (loading_ && loading_->client == client);
}

bool SceneLoader::busy() const {
    const std::lock_guard lock(mutex_);
    return loading_.has_value();
}

std::optional<LoadState> SceneLoader::state(ClientId client) const {
    const std::lock_guard lock(mutex_);
    if (loading_ && loading_->client == client)
        return LoadState{step_, std::chrono::duration<double>(Clock::now() - began_).count()};
    return waits(client) ? std::optional(LoadState{"waiting", 0.0}) : std::nullopt;
}

void SceneLoader::noteStep(std::string_view step) {
    const std::lock_guard lock(mutex_);
    step_ = step;
}

std::vector<SceneLoader::LoadJob> SceneLoader::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    abandon_ = true;
    const std::deque<LoadJob> waiting = std::exchange(queue_, {});
    return {waiting.begin(), waiting.end()};
}

std::optional<SceneLoader::LoadJob> SceneLoader::takeCurrent() {
    const std::lock_guard lock(mutex_);
    return std::exchange(loading_, std::nullopt);
}

void SceneLoader::loop() {
    while (true) {
        LoadJob job;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return stopping_ || (!closed_ && !queue_.empty()); });
            if (stopping_) return;
            job = std::move(queue_.front());
            queue_.pop_front();
            loading_ = job;
            step_ = "reading the scene";
            began_ = Clock::now();
            abandon_ = false;
        }
        load(job);
    }
}

SlotPointer SceneLoader::slotFor(const LoadJob& job) {
    const auto start = Clock::now();
    const SourcedScene found = sourceScene(job.load, config_, job.client);
    if (SlotPointer held = host_.find(found.key)) return held;
    instruments_.log.event("info", "scene_loading", {{"client", job.client}, {"scene", found.scene.source}});
    const auto abandoned = [this] {
        if (abandon_) throw Cancelled{};
    };
    auto slot = std::make_shared<SceneSlot>(found.key, found.scene, config_, abandoned,
                                            [this](std::string_view step) { noteStep(step); });
    host_.keep(slot);
    instruments_.metrics.add(Metrics::scenesLoaded);
    instruments_.log.event("info", "scene_loaded",
                           {{"client", job.client},
                            {"scene", found.scene.source},
                            {"seconds", std::chrono::duration<double>(Clock::now() - start).count()}});
    return slot;
}

void SceneLoader::load(const LoadJob& job) {
    try {
        host_.loaded(job, slotFor(job));
    } catch (const RequestError& e) {
        host_.failed(job, {e.code, e.what(), e.where});
    } catch (const Cancelled&) {
        host_.failed(job, {"shutting_down", "the service is shutting down", {}});  // or its client is gone
    } catch (const TooSlow& e) {
        host_.failed(job, {"too_large", e.what(), {}});
    } catch (const InputError& e) {
        host_.failed(job, {"bad_request", e.what(), {}});
    } catch (const std::bad_alloc&) {
        host_.failed(job, {"too_large", "the scene does not fit into memory", {}});
    } catch (const std::exception& e) {
        host_.failed(job, {"internal", e.what(), {}});
    }
}

}  // namespace lumulus::service
