#include "service/render/scene_desk.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

SceneDesk::SceneDesk(const RenderConfig& config, Instruments& instruments, Host host)
    : config_(config),
      instruments_(instruments),
      host_(std::move(host)),
      defaultPending_(!config.defaultScene.empty()),
      loader_(config, instruments, loaderHost()) {
    if (defaultPending_) {
        const std::lock_guard lock(host_.mutex);
        loadDefault();
    } else {
        host_.begun(nullptr);
    }
}

/// With the lock held, so that the load cannot end before the loader knows of it.
void SceneDesk::loadDefault() {
    default_ = std::make_unique<DefaultScene>(config_, instruments_, defaultHost());
    loader_.holdBack(default_->key());
}

void SceneDesk::stop() {
    loader_.stop();
    default_.reset();
    ended_.clear();
}

void SceneDesk::loadDefaultAgain() {
    const std::chrono::duration<double> lasted = Clock::now() - defaultLoaded_;
    if (defaultPending_ || !default_ || lasted.count() < config_.limits.reloadSeconds) return;
    ended_.clear();  // these threads have ended
    ended_.push_back(std::move(default_));
    try {
        loadDefault();
    } catch (const InputError& e) {  // its file is gone meanwhile
        instruments_.log.event("error", "scene_refused", {{"message", e.what()}});
        return;
    }
    defaultPending_ = true;
    for (const ClientId client : host_.scenes.withoutScene()) host_.scheduler.setWaiting(client, true);
}

void SceneDesk::submit(LoadJob job) {
    const ClientId client = job.client;
    loader_.submit(std::move(job));
    giveUpDensities(client);
    for (const std::uint64_t request : host_.changes.cancelDensities(client)) supersede(client, request);
    host_.scheduler.setWaiting(client, true);
}

bool SceneDesk::cancel(ClientId client, std::uint64_t id) {
    return !takeDensities(client, id).empty();
}

/// Ends what is prepared for a client: all, or by one request.
std::vector<LoadJob> SceneDesk::takeDensities(ClientId client, std::optional<std::uint64_t> id) {
    std::vector<LoadJob> jobs = loader_.takeDensities(client, id);
    for (LoadJob& job : host_.densities.take(client, id)) jobs.push_back(std::move(job));
    if (!jobs.empty()) host_.scenes.breakPromise(client);
    return jobs;
}

/// Of a client who wants another one, or another scene.
void SceneDesk::giveUpDensities(ClientId client) {
    for (const LoadJob& job : takeDensities(client, std::nullopt)) supersede(client, job.id);
}

void SceneDesk::supersede(ClientId client, std::uint64_t request) {
    host_.reply(client, request, Failure{"superseded", "a newer density or scene of the client takes its place", {}});
}

void SceneDesk::prepare(LoadJob job) {
    const ClientId client = job.client;
    if (!host_.scenes.knows(client)) return;  // it has left meanwhile
    if (loader_.worksFor(client)) throw RequestError("busy", "a scene is being loaded for the client: wait for it");
    giveUpDensities(client);
    host_.scenes.promiseOwn(client);
    loader_.submit(std::move(job));
}

void SceneDesk::addClient(ClientId client) {
    letWait(client, false);
}

/// Nothing of a client is taken while it waits for a scene.
void SceneDesk::letWait(ClientId client, bool loads) {
    host_.scheduler.setWaiting(client, loads || (defaultPending_ && !host_.scenes.shownTo(client)));
}

std::vector<LoadJob> SceneDesk::close() {
    if (std::exchange(defaultPending_, false)) {
        default_->abandon();
        defaultEnded_.notify_all();
        for (const ClientId client : host_.scenes.withoutScene()) host_.scheduler.setWaiting(client, false);
    }
    std::vector<LoadJob> waiting = loader_.close();
    for (const auto& job : waiting) host_.scheduler.setWaiting(job.client, false);
    return waiting;
}

/// A scene that is held, or will be: who asks for the default scene waits for it.
SlotPointer SceneDesk::find(const std::string& key) {
    std::unique_lock lock(host_.mutex);
    if (default_ && default_->key() == key && defaultPending_) {
        defaultEnded_.wait(lock, [this] { return !defaultPending_; });
        if (default_->abandoned()) throw Cancelled{};  // the service ends
    }
    return host_.scenes.find(key);
}

SceneLoader::Host SceneDesk::loaderHost() {
    SceneLoader::Host host;
    host.find = [this](const std::string& key) { return find(key); };
    host.keep = [this](const SlotPointer& slot) { keep(slot); };
    host.loaded = [this](const LoadJob& job, const SlotPointer& slot) { loaded(job, slot); };
    host.densities = [this](const LoadJob& job, const scene::Scene& next, const std::function<void()>& check) {
        return host_.densities.densities(job, next, check);
    };
    host.before = [this](const LoadJob& job, const SlotPointer& slot, const std::function<void()>& check) {
        makeRoomFor(slot);
        return host_.densities.before(job, check);
    };
    host.prepared = [this](const LoadJob& job, SlotPointer slot, DensityChanged changed, MemoryBudget::Share light) {
        prepared(job, std::move(slot), std::move(changed), std::move(light));
    };
    host.failed = [this](const LoadJob& job, const Failure& failure) { loadFailed(job, failure); };
    return host;
}

DefaultScene::Host SceneDesk::defaultHost() {
    DefaultScene::Host host;
    host.loaded = [this](const SlotPointer& slot) { defaultLoaded(slot); };
    host.failed = [this](const std::exception_ptr& error) { defaultFailed(error); };
    return host;
}

/// Draws the memory of a scene from the budget. Errors: RequestError `busy`.
void SceneDesk::makeRoomFor(const SlotPointer& slot) {
    makeRoom(host_.mutex, host_.scenes, [&] { return slot->holdMemory(instruments_.memory); });
}

void SceneDesk::prepared(const LoadJob& job, SlotPointer slot, DensityChanged changed, MemoryBudget::Share light) {
    makeRoomFor(slot);
    light = {};
    {
        const std::lock_guard lock(host_.mutex);
        const std::optional<bool> waits = loader_.end(job);
        if (!waits || !host_.scenes.knows(job.client)) return;  // nobody waits for it any more
        host_.densities.add(job, std::move(slot), std::move(changed));
    }
    host_.ended();
}

void SceneDesk::keep(const SlotPointer& slot) {
    makeRoomFor(slot);
    slot->onStep([step = host_.step, raw = slot.get()] { return step(*raw); });
    SlotPointer dropped;  // ends after the lock
    const std::lock_guard lock(host_.mutex);
    dropped = host_.scenes.keep(slot);
    instruments_.metrics.set(Metrics::scenesHeld, static_cast<std::int64_t>(host_.scenes.size()));
}

void SceneDesk::defaultLoaded(const SlotPointer& slot) {
    keep(slot);
    {
        const std::lock_guard lock(host_.mutex);
        if (!std::exchange(defaultPending_, false)) return;
        defaultLoaded_ = Clock::now();
        loader_.holdBack({});
        host_.scenes.setDefault(slot);
        for (const ClientId client : host_.scenes.withoutScene()) {
            host_.scenes.show(client, slot);
            letWait(client, loader_.worksFor(client));
        }
    }
    defaultEnded_.notify_all();
    if (!std::exchange(begun_, true)) host_.begun(nullptr);
    host_.ended();
}

/// At the start the host decides; later on clients go on without the scene.
void SceneDesk::defaultFailed(const std::exception_ptr& error) {
    if (!std::exchange(begun_, true)) return host_.begun(error);
    {
        const std::lock_guard lock(host_.mutex);
        defaultPending_ = false;
        loader_.holdBack({});
        for (const ClientId client : host_.scenes.withoutScene()) letWait(client, loader_.worksFor(client));
    }
    defaultEnded_.notify_all();
    host_.ended();
}

/// The scene, under the light that the next picture shows. With the lock held.
SceneDescription SceneDesk::describe(const SlotPointer& slot) const {
    SceneDescription description = slot->description();
    if (const auto state = host_.scenes.stateOf(*slot)) description.light = host_.changes.after(state->light, slot);
    return description;
}

void SceneDesk::loaded(const LoadJob& job, const SlotPointer& slot) {
    {
        const std::lock_guard lock(host_.mutex);
        const bool known = host_.scenes.knows(job.client);
        if (known && !host_.scenes.holds(slot)) throw RequestError("busy", "the scene has gone: load it again");
        const std::optional<bool> waits = loader_.end(job);
        if (known && waits) {
            host_.scenes.show(job.client, slot);
            letWait(job.client, *waits);
            host_.reply(job.client, job.id, describe(slot));
        }
    }
    host_.ended();
}

void SceneDesk::loadFailed(const LoadJob& job, const Failure& failure) {
    bool answered = false;
    {
        const std::lock_guard lock(host_.mutex);
        if (const std::optional<bool> waits = loader_.end(job)) {
            if (job.density) host_.scenes.breakPromise(job.client);
            letWait(job.client, *waits);
            host_.reply(job.client, job.id, failure);
            answered = true;
        }
    }
    host_.ended();
    if (!answered) return;
    instruments_.log.event("warning", "scene_refused",
                           {{"client", job.client}, {"code", failure.code}, {"message", failure.text}});
}

}  // namespace lumulus::service
