#include "service/render/scene_loader.h"

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "service/render/scene_source.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::size_t mostWaiting = 4;  // of one client

const Failure givenUp{"shutting_down", "the service is shutting down", {}};  // or its client is gone

}  // namespace

SceneLoader::SceneLoader(const RenderConfig& config, Instruments& instruments, Host host)
    : config_(config), instruments_(instruments), host_(std::move(host)) {
    for (Lane& lane : lanes_) lane.thread = std::thread([this, &lane] { loop(lane); });
}

SceneLoader::~SceneLoader() {
    stop();
}

void SceneLoader::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = closed_ = true;
        for (Lane& lane : lanes_) lane.abandon = true;
    }
    wake_.notify_all();
    for (Lane& lane : lanes_)
        if (lane.thread.joinable()) lane.thread.join();
}

void SceneLoader::submit(LoadJob job) {
    {
        const std::lock_guard lock(mutex_);
        if (queue_.count(job.client) >= mostWaiting)
            throw RequestError("busy", "four scenes wait to be loaded already");
        queue_.push(std::move(job), Clock::now());
    }
    wake_.notify_all();
}

void SceneLoader::removeClient(ClientId client) {
    const std::lock_guard lock(mutex_);
    queue_.removeClient(client);
    for (Lane& lane : lanes_)
        if (lane.job && lane.job->client == client) lane.abandon = true;
}

std::optional<bool> SceneLoader::end(const LoadJob& job) {
    const std::lock_guard lock(mutex_);
    for (Lane& lane : lanes_) {
        if (!lane.job || lane.job->client != job.client || lane.job->id != job.id) continue;
        lane.job.reset();
        wake_.notify_all();
        return queue_.count(job.client) > 0;
    }
    return std::nullopt;
}

void SceneLoader::holdBack(std::string key) {
    {
        const std::lock_guard lock(mutex_);
        held_ = std::move(key);
    }
    wake_.notify_all();
}

const SceneLoader::Lane* SceneLoader::laneOf(ClientId client) const {
    const auto lane =
        std::ranges::find_if(lanes_, [&](const Lane& one) { return one.job && one.job->client == client; });
    return lane == lanes_.end() ? nullptr : &*lane;
}

bool SceneLoader::worksFor(ClientId client) const {
    const std::lock_guard lock(mutex_);
    return queue_.count(client) > 0 || laneOf(client) != nullptr;
}

bool SceneLoader::busy() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(lanes_, [](const Lane& lane) { return lane.job.has_value(); });
}

std::optional<LoadState> SceneLoader::state(ClientId client) const {
    const std::lock_guard lock(mutex_);
    if (const Lane* lane = laneOf(client))
        return LoadState{lane->step, std::chrono::duration<double>(Clock::now() - lane->began).count()};
    return queue_.count(client) > 0 ? std::optional(LoadState{"waiting", 0.0}) : std::nullopt;
}

void SceneLoader::noteStep(Lane& lane, std::string_view step) {
    const std::lock_guard lock(mutex_);
    lane.step = step;
}

std::vector<LoadJob> SceneLoader::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    for (Lane& lane : lanes_) lane.abandon = true;
    return queue_.takeAll();
}

std::vector<LoadJob> SceneLoader::takeCurrent() {
    const std::lock_guard lock(mutex_);
    std::vector<LoadJob> jobs;
    for (Lane& lane : lanes_)
        if (auto job = std::exchange(lane.job, std::nullopt)) jobs.push_back(std::move(*job));
    return jobs;
}

/// Takes the next entry for a lane, where there is one. With the lock held.
std::optional<LoadQueue::Entry> SceneLoader::begin(Lane& lane) {
    std::vector<LoadQueue::Running> running;
    for (const Lane& one : lanes_)
        if (one.job) running.push_back({one.job->client, one.key, one.large});
    const auto now = Clock::now();
    std::optional<LoadQueue::Entry> entry = queue_.take(running, held_, now);
    if (!entry) return entry;
    lane.job = entry->job;
    lane.key = entry->source ? entry->source->key : std::string();
    lane.large = entry->large();
    lane.step = "reading the scene";
    lane.began = now;
    lane.abandon = false;
    return entry;
}

void SceneLoader::loop(Lane& lane) {
    while (true) {
        std::optional<LoadQueue::Entry> entry;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return stopping_ || (!closed_ && (entry = begin(lane))); });
            if (!entry) return;
        }
        if (entry->source)
            load(lane, *entry);
        else
            findSource(lane, std::move(*entry));
    }
}

/// Looks what a load is of, and lets it wait until a loader is free.
void SceneLoader::findSource(Lane& lane, LoadQueue::Entry entry) {
    const LoadJob job = entry.job;
    answer(job, [&] {
        entry.source = std::make_shared<const SourcedScene>(sourceScene(job.load, config_, job.client));
        entry.cost = loadCost(entry.source->scene);
        const std::lock_guard lock(mutex_);
        if (lane.abandon || closed_) throw Cancelled{};
        lane.job.reset();
        queue_.putBack(std::move(entry));
        wake_.notify_all();
    });
}

SlotPointer SceneLoader::slotFor(Lane& lane, const LoadQueue::Entry& entry) {
    const auto start = Clock::now();
    const SourcedScene& found = *entry.source;
    const LoadJob& job = entry.job;
    if (SlotPointer held = host_.find(found.key)) return held;
    instruments_.log.event("info", "scene_loading", {{"client", job.client}, {"scene", found.scene.source}});
    const auto abandoned = [&lane] {
        if (lane.abandon) throw Cancelled{};
    };
    auto slot = std::make_shared<SceneSlot>(found.key, found.scene, config_, abandoned,
                                            [&](std::string_view step) { noteStep(lane, step); });
    abandoned();  // the last step may not have asked: nobody keeps a scene that nobody waits for
    if (job.load.isPrivate) slot->giveTo(job.client);
    host_.keep(slot);
    instruments_.metrics.add(Metrics::scenesLoaded);
    instruments_.log.event("info", "scene_loaded",
                           {{"client", job.client},
                            {"scene", found.scene.source},
                            {"seconds", std::chrono::duration<double>(Clock::now() - start).count()}});
    return slot;
}

void SceneLoader::load(Lane& lane, const LoadQueue::Entry& entry) {
    answer(entry.job, [&] { host_.loaded(entry.job, slotFor(lane, entry)); });
}

/// Does work for a job, and answers the job where that fails.
template <typename Work>
void SceneLoader::answer(const LoadJob& job, const Work& work) {
    try {
        work();
    } catch (const RequestError& e) {
        host_.failed(job, {e.code, e.what(), e.where});
    } catch (const Cancelled&) {
        host_.failed(job, givenUp);
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
