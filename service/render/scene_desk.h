#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "service/render/default_scene.h"
#include "service/render/pending_changes.h"
#include "service/render/scene_loader.h"
#include "service/render/scene_store.h"
#include "service/render/scheduler.h"
#include "service/telemetry/instruments.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Brings scenes to the clients who wait for them: the default scene at the start, and those that clients ask for. What
/// it changes is guarded by the lock of the render service.
class SceneDesk {
  public:
    struct Host {
        std::mutex& mutex;  ///< guards the next three
        Scheduler& scheduler;
        SceneStore& scenes;
        PendingChanges& changes;
        /// Takes an answer, with the lock held.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// A load has ended, and clients may go on. Without the lock.
        std::function<void()> ended;
        /// The default scene is there, or cannot be. Without the lock.
        std::function<void(std::exception_ptr)> begun;
        /// Called between the steps of all work on scenes that are held.
        std::function<void()> step;
    };

    /// Begins to load the default scene, where there is one. `config` and `instruments` must outlive this.
    /// Errors: InputError for a scene file that is not there or is wrong.
    SceneDesk(const RenderConfig& config, Instruments& instruments, Host host);
    SceneDesk(const SceneDesk&) = delete;
    SceneDesk& operator=(const SceneDesk&) = delete;
    ~SceneDesk() { stop(); }

    // With the lock held:

    /// Errors: RequestError `busy` where the client waits for too many scenes.
    void submit(SceneLoader::LoadJob job);
    /// Lets the client wait for the default scene, where that is loaded still.
    void addClient(ClientId client);
    void removeClient(ClientId client) { loader_.removeClient(client); }
    bool defaultPending() const { return defaultPending_; }
    bool busy() const { return loader_.busy(); }
    std::optional<LoadState> loadState(ClientId client) const { return loader_.state(client); }
    /// Gives up the loads under way, refuses those to come, and returns those that waited. Nobody waits any more.
    std::vector<SceneLoader::LoadJob> close();
    /// Takes the load under way, which will not be answered any more.
    std::optional<SceneLoader::LoadJob> takeCurrent() { return loader_.takeCurrent(); }

    /// Ends the threads. Without the lock.
    void stop();

  private:
    SceneLoader::Host loaderHost();
    SlotPointer find(const std::string& key);
    DefaultScene::Host defaultHost();
    void keep(const SlotPointer& slot);
    void defaultLoaded(const SlotPointer& slot);
    void loaded(const SceneLoader::LoadJob& job, const SlotPointer& slot);
    void loadFailed(const SceneLoader::LoadJob& job, const Failure& failure);
    void letWait(ClientId client, bool loads);
    SceneDescription describe(const SlotPointer& slot) const;

    Instruments& instruments_;
    Host host_;
    bool defaultPending_;
    std::condition_variable defaultEnded_;  // it is not pending any more
    SceneLoader loader_;                    // has a lock of its own, which is taken after the service's
    std::unique_ptr<DefaultScene> default_;
};

}  // namespace lumulus::service
