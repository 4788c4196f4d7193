#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "service/render/default_scene.h"
#include "service/render/density_desk.h"
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
        std::mutex& mutex;  ///< guards the next four
        Scheduler& scheduler;
        SceneStore& scenes;
        PendingChanges& changes;
        DensityDesk& densities;
        /// Takes an answer, with the lock held.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// A load has ended, and clients may go on. Without the lock.
        std::function<void()> ended;
        /// The default scene is there, or cannot be. Without the lock.
        std::function<void(std::exception_ptr)> begun;
        /// Called with a slot between the steps of all work on it while it is held. Returns the seconds of the next.
        std::function<double(const SceneSlot&)> step;
    };

    /// Begins to load the default scene, where there is one. `config` and `instruments` must outlive this.
    /// Errors: InputError for a scene file that is not there or is wrong.
    SceneDesk(const RenderConfig& config, Instruments& instruments, Host host);
    SceneDesk(const SceneDesk&) = delete;
    SceneDesk& operator=(const SceneDesk&) = delete;
    ~SceneDesk() { stop(); }

    // With the lock held:

    /// Errors: RequestError `busy` where the client waits for too many scenes.
    void submit(LoadJob job);
    /// Prepares another density beside the pictures, and answers the job, in the place of one that the client waits
    /// for. Errors: RequestError `busy` where the client waits for a scene.
    void prepare(LoadJob job);
    /// Ends the preparation of the density that a client has asked for by this request. Returns whether there was one:
    /// nobody answers it any more.
    bool cancel(ClientId client, std::uint64_t id);
    /// Lets the client wait for the default scene, where that is loaded still.
    void addClient(ClientId client);
    void removeClient(ClientId client) { loader_.removeClient(client); }
    bool defaultPending() const { return defaultPending_; }
    /// Loads the default scene once more, which is held no longer: clients without a scene wait for it. A scene that
    /// did not last stays gone: loading it again would not end.
    void loadDefaultAgain();
    bool busy() const { return loader_.busy(); }
    /// How far the client's load is that is under way, or else the one that waits.
    std::optional<LoadState> state(ClientId client) const { return loader_.state(client); }
    /// Gives up the loads under way, refuses those to come, and returns those that waited. Nobody waits any more.
    std::vector<LoadJob> close();
    /// Takes the loads under way, which will not be answered any more.
    std::vector<LoadJob> takeCurrent() { return loader_.takeCurrent(); }

    /// Ends the threads. Without the lock.
    void stop();

  private:
    SceneLoader::Host loaderHost();
    SlotPointer find(const std::string& key);
    DefaultScene::Host defaultHost();
    void keep(const SlotPointer& slot);
    void loadDefault();
    void defaultLoaded(const SlotPointer& slot);
    void defaultFailed(const std::exception_ptr& error);
    void loaded(const LoadJob& job, const SlotPointer& slot);
    void loadFailed(const LoadJob& job, const Failure& failure);
    void makeRoomFor(const SlotPointer& slot);
    void prepared(const LoadJob& job, SlotPointer slot, DensityChanged changed, MemoryBudget::Share light);
    std::vector<LoadJob> takeDensities(ClientId client, std::optional<std::uint64_t> id);
    void giveUpDensities(ClientId client);
    void supersede(ClientId client, std::uint64_t request);
    void letWait(ClientId client, bool loads);
    SceneDescription describe(const SlotPointer& slot) const;

    const RenderConfig& config_;
    Instruments& instruments_;
    Host host_;
    Clock::time_point defaultLoaded_;                   // last time
    bool begun_ = false;                                // the host knows how the first load of the default scene ended
    std::vector<std::unique_ptr<DefaultScene>> ended_;  // loads of the default scene; their threads are done
    bool defaultPending_;
    std::condition_variable defaultEnded_;  // it is not pending any more
    SceneLoader loader_;                    // has a lock of its own, which is taken after the service's
    std::unique_ptr<DefaultScene> default_;
};

}  // namespace lumulus::service
