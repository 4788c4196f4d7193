#include "service/render/scene_loader.h"

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "service/render/density_source.h"
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
        if (!job.density && queue_.count(job.client) >= mostWaiting)
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

std::vector<LoadJob> SceneLoader::takeDensities(ClientId client, std::optional<std::uint64_t> id) {
    const std::lock_guard lock(mutex_);
    std::vector<LoadJob> taken = queue_.takeDensities(client, id);
    for (Lane& lane : lanes_) {
        if (!lane.job || lane.job->client != client || !lane.job->density) continue;
        if (id && lane.job->id != *id) continue;
        lane.abandon = true;
        taken.push_back(*std::exchange(lane.job, std::nullopt));
    }
    return taken;
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

/// What ends the work of a lane.
std::function<void()> SceneLoader::stopFor(const Lane& lane) {
    return [&lane] {
        if (lane.abandon) throw Cancelled{};
    };
}

const SceneLoader::Lane* SceneLoader::laneOf(ClientId client) const {
    const auto lane =
        std::ranges::find_if(lanes_, [&](const Lane& one) { return one.job && one.job->client == client; });
    return lane == lanes_.end() ? nullptr : &*lane;
}

bool SceneLoader::worksFor(ClientId client) const {
    const std::lock_guard lock(mutex_);
    return queue_.count(client) > 0 || std::ranges::any_of(lanes_, [client](const Lane& lane) {
               return lane.job && lane.job->client == client && !lane.job->density;
           });
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
        if (!entry->source)
            findSource(lane, std::move(*entry));
        else if (entry->job.density)
            prepare(lane, *entry);
        else
            load(lane, *entry);
    }
}

/// Looks what a load is of, and lets it wait until a loader is free.
void SceneLoader::findSource(Lane& lane, LoadQueue::Entry entry) {
    const LoadJob job = entry.job;
    answer(job, [&] {
        entry.source =
            std::make_shared<const SourcedScene>(job.density ? sourceDensity(*job.density, config_, job.client, job.id)
                                                             : sourceScene(job.load, config_, job.client));
        entry.cost = loadCost(entry.source->scene);
        const std::lock_guard lock(mutex_);
        if (lane.abandon || closed_) throw Cancelled{};
        lane.job.reset();
        queue_.putBack(std::move(entry));
        wake_.notify_all();
    });
}

SlotPointer SceneLoader::makeSlot(Lane& lane, const LoadQueue::Entry& entry, DensityCopies copies) {
    const SourcedScene& found = *entry.source;
    instruments_.log.event("info", "scene_loading", {{"client", entry.job.client}, {"scene", found.scene.source}});
    return std::make_shared<SceneSlot>(
        found, config_, stopFor(lane), [&](std::string_view step) { noteStep(lane, step); }, std::move(copies));
}

SlotPointer SceneLoader::slotFor(Lane& lane, const LoadQueue::Entry& entry) {
    const auto start = Clock::now();
    const SourcedScene& found = *entry.source;
    const LoadJob& job = entry.job;
    if (SlotPointer held = host_.find(found.key)) return held;
    SlotPointer slot = makeSlot(lane, entry, {});
    stopFor(lane)();  // the last step may not have asked: nobody keeps a scene that nobody waits for
    if (job.load.isPrivate) slot->giveTo(job.client);
    host_.keep(slot);
    noteLoaded(entry, start);
    return slot;
}

void SceneLoader::noteLoaded(const LoadQueue::Entry& entry, Clock::time_point start) {
    instruments_.metrics.add(Metrics::scenesLoaded);
    instruments_.log.event("info", "scene_loaded",
                           {{"client", entry.job.client},
                            {"scene", entry.source->scene.source},
                            {"seconds", std::chrono::duration<double>(Clock::now() - start).count()}});
}

void SceneLoader::load(Lane& lane, const LoadQueue::Entry& entry) {
    answer(entry.job, [&] { host_.loaded(entry.job, slotFor(lane, entry)); });
}

/// Makes a scene with another density, and lets it go on with the light of the one that is shown meanwhile.
void SceneLoader::prepare(Lane& lane, const LoadQueue::Entry& entry) {
    const LoadJob& job = entry.job;
    answer(job, [&] {
        const auto start = Clock::now();
        noteStep(lane, "reading densities back");
        DensitiesBefore densities = host_.densities(job, entry.source->scene, stopFor(lane));
        SlotPointer slot = makeSlot(lane, entry, std::move(densities.copies));
        densities = {};
        noteStep(lane, "waiting for the light of before");
        SceneBefore before = host_.before(job, slot, stopFor(lane));
        DensityChanged changed;
        changed.carried = slot->goOnFrom(before, job.density->density.seconds);
        changed.clouds = cloudsShown(entry.source->scene, *job.density);
        stopFor(lane)();
        noteLoaded(entry, start);
        host_.prepared(job, std::move(slot), std::move(changed), std::move(before.memory));
    });
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
