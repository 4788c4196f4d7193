#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "service/render/scene_store.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

/// Loads scenes that clients ask for, one after the other, on a thread of its own.
class SceneLoader {
  public:
    struct LoadJob {
        ClientId client = 0;
        std::uint64_t id = 0;
        LoadScene load;
        std::shared_ptr<MemoryBudget::Share> memory = {};  ///< that the request holds
    };
    /// What the loader calls, on its thread and without its lock.
    struct Host {
        /// A scene that is held already; null where it is not.
        std::function<SlotPointer(const std::string& key)> find;
        /// Takes a new scene. Errors: RequestError.
        std::function<void(const SlotPointer&)> keep;
        /// Takes the outcome. Has to call end(). Errors of `loaded`: RequestError, which goes to `failed`.
        std::function<void(const LoadJob&, const SlotPointer&)> loaded;
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
    /// Ends the load under way. Returns whether the client waits for another; none where somebody has answered it.
    std::optional<bool> end(const LoadJob& job);
    bool busy() const;
    /// Whether a load of the client waits or is under way.
    bool worksFor(ClientId client) const;
    /// How far the client's load is that is under way, or else the one that waits.
    std::optional<LoadState> state(ClientId client) const;
    /// Gives up the load under way, refuses those to come, and returns those that waited.
    std::vector<LoadJob> close();
    /// Takes the load under way, which its thread will not answer any more.
    std::optional<LoadJob> takeCurrent();
    /// Ends the thread.
    void stop();

  private:
    void loop();
    void load(const LoadJob& job);
    SlotPointer slotFor(const LoadJob& job);
    void noteStep(std::string_view step);
    bool waits(ClientId client) const;

    const RenderConfig& config_;
    Instruments& instruments_;
    Host host_;

    mutable std::mutex mutex_;  // guards what follows
    std::condition_variable wake_;
    std::deque<LoadJob> queue_;
    std::optional<LoadJob> loading_;  // its client waits for it
    std::string step_;                // of the load under way, since `began_`
    Clock::time_point began_;
    bool closed_ = false, stopping_ = false;
    std::atomic<bool> abandon_{false};  // ends the load under way

    std::thread thread_;
};

}  // namespace lumulus::service
