#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "service/render/load_queue.h"
#include "service/render/scene_before.h"
#include "service/render/scene_store.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

/// Loads scenes that clients ask for on two threads of its own, in the order of LoadQueue.
class SceneLoader {
  public:
    /// What the loader calls, on its threads and without its lock.
    struct Host {
        /// A scene that is held already; null where it is not.
        std::function<SlotPointer(const std::string& key)> find;
        /// Takes a new scene. Errors: RequestError.
        std::function<void(const SlotPointer&)> keep;
        /// Takes the outcome. Has to call end(). Errors of `loaded`: RequestError, which goes to `failed`.
        std::function<void(const LoadJob&, const SlotPointer&)> loaded;
        /// What a scene with another density need not load. Calls `check` while it waits, and throws what that throws.
        /// Errors: RequestError.
        std::function<DensitiesBefore(const LoadJob&, const scene::Scene&, const std::function<void()>& check)>
            densities;
        /// The scene that goes on as the slot, which has another density, when it is ready to. Waits and throws as
        /// above.
        std::function<SceneBefore(const LoadJob&, const SlotPointer&, const std::function<void()>& check)> before;
        /// Takes a scene with another density, and whether it goes on with light, in the place of `loaded`. `light`
        /// counts until the scene is counted whole.
        std::function<void(const LoadJob&, SlotPointer, DensityChanged, MemoryBudget::Share light)> prepared;
        std::function<void(const LoadJob&, const Failure&)> failed;
    };

    /// `config` and `instruments` must outlive this.
    SceneLoader(const RenderConfig& config, Instruments& instruments, Host host);
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;
    ~SceneLoader();

    /// Errors: RequestError `busy` where the client waits for too many scenes.
    void submit(LoadJob job);
    /// Forgets what the client waits for; a load under way for it is given up.
    void removeClient(ClientId client);
    /// Gives up the densities that a client waits for, or that of one request, and returns them: nobody answers them
    /// any more.
    std::vector<LoadJob> takeDensities(ClientId client, std::optional<std::uint64_t> id);
    /// Ends a load under way. Returns whether the client waits for another; none where somebody has answered it.
    std::optional<bool> end(const LoadJob& job);
    /// The scene of this key is being loaded elsewhere: nobody loads it here. Empty: there is none.
    void holdBack(std::string key);
    bool busy() const;
    /// How far the client's load is that is under way, or else the one that waits.
    std::optional<LoadState> state(ClientId client) const;
    /// Whether a load of the client waits or is under way, densities apart.
    bool worksFor(ClientId client) const;
    /// Gives up the loads under way, refuses those to come, and returns those that waited.
    std::vector<LoadJob> close();
    /// Takes the loads under way, which their threads will not answer any more.
    std::vector<LoadJob> takeCurrent();
    /// Ends the threads.
    void stop();

  private:
    /// A thread, and the load that is under way on it.
    struct Lane {
        std::optional<LoadJob> job;  // its client waits for it
        std::string key;             // as LoadQueue::Running
        bool large = false;
        std::string step;  // of the load, since `began`
        Clock::time_point began;
        std::atomic<bool> abandon{false};  // ends the load
        std::thread thread;
    };

    void loop(Lane& lane);
    std::optional<LoadQueue::Entry> begin(Lane& lane);
    void findSource(Lane& lane, LoadQueue::Entry entry);
    void load(Lane& lane, const LoadQueue::Entry& entry);
    template <typename Work>
    void answer(const LoadJob& job, const Work& work);
    SlotPointer slotFor(Lane& lane, const LoadQueue::Entry& entry);
    SlotPointer makeSlot(Lane& lane, const LoadQueue::Entry& entry, DensityCopies copies);
    void prepare(Lane& lane, const LoadQueue::Entry& entry);
    void noteLoaded(const LoadQueue::Entry& entry, Clock::time_point start);
    static std::function<void()> stopFor(const Lane& lane);
    void noteStep(Lane& lane, std::string_view step);
    const Lane* laneOf(ClientId client) const;

    const RenderConfig& config_;
    Instruments& instruments_;
    Host host_;

    mutable std::mutex mutex_;  // guards what follows, but for threads and `abandon`
    std::condition_variable wake_;
    LoadQueue queue_;
    std::string held_;
    bool closed_ = false, stopping_ = false;
    std::array<Lane, 2> lanes_;
};

}  // namespace lumulus::service
