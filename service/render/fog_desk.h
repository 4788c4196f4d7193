#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "render/new_fog.h"
#include "service/render/light_desk.h"
#include "service/render/media_source.h"
#include "service/render/scene_store.h"
#include "service/telemetry/instruments.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Changes of fog, from being asked for to being shown. Light in other fog takes up to a second to find, which a thread
/// of low priority does beside the pictures; the render thread puts the fog in its place between two of them. Of what a
/// client asks for meanwhile the newest counts, and nothing else waits.
class FogDesk {
  public:
    struct Host {
        std::mutex& mutex;  ///< guards `scenes` and what is kept here
        SceneStore& scenes;
        LightDesk& lights;
        /// Takes an answer, with the lock held.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// There is work for the render thread. Without the lock.
        std::function<void()> wake;
    };
    /// What a client has asked for.
    struct Asked {
        ClientId client = 0;
        std::uint64_t id = 0;
        std::vector<MediumEdit> edits;
        std::shared_ptr<MemoryBudget::Share> memory = {};  ///< that the request holds
    };

    /// `config` and `instruments` must outlive this.
    FogDesk(const RenderConfig& config, Instruments& instruments, Host host);
    FogDesk(const FogDesk&) = delete;
    FogDesk& operator=(const FogDesk&) = delete;
    ~FogDesk() { stop(); }

    // With the lock held:

    /// Takes a change, in the place of one that waits and changes nothing else. Errors: RequestError `busy` where too
    /// many of the client wait.
    void submit(Asked asked);
    /// Whether there is work for the render thread.
    bool any() const { return begun_ ? found_.has_value() : !asked_.empty(); }
    /// Answers with `superseded` what a client has asked for, whose scene another one takes the place of.
    void giveUp(ClientId client);
    void removeClient(ClientId client) { take(client); }
    /// All that nobody has answered yet; they are forgotten.
    std::vector<Asked> takeAll() { return take({}); }

    /// Ends the thread. Without the lock.
    void stop();

    // On the render thread, without the lock:

    /// Begins what waits and shows what is found, where no picture of the scene is being drawn.
    void work();

  private:
    /// Changes of one client, which become one fog.
    struct Job {
        std::vector<Asked> asked;  ///< of one client, in their order
        std::string scene;         ///< key of the scene, as it was loaded
        FogMaker maker;
        std::shared_ptr<const LoadScene> load;
        bool lit = false;       ///< clouds are in the light that comes through the fog
        std::size_t media = 0;  ///< of the scene
        MediaKeys keys;         ///< that are changed already
        std::atomic<bool> cancelled = false;
    };
    /// What becomes of them.
    struct Found {
        std::vector<Asked> made;
        std::vector<std::pair<Asked, Failure>> refused;
        MediaKeys keys;
        std::shared_ptr<const NewFog> fog;  ///< null where all are refused
        double milliseconds = 0.0;          ///< that finding it took
    };

    ClientId client() const { return begun_->asked.front().client; }
    std::vector<Asked> take(std::optional<ClientId> client);
    void begin(std::vector<Asked> asked);
    std::vector<Asked> nextToBegin();
    void show(const Job& job, const Found& found);
    void put(const Job& job, const Found& found);
    void fail(const Asked& asked, const Failure& failure);
    void loop();
    Found find(const Job& job) const;

    const RenderConfig& config_;
    Instruments& instruments_;
    Host host_;
    std::condition_variable wake_;
    std::deque<Asked> asked_;
    std::shared_ptr<Job> begun_;  // one at a time; only `cancelled` changes
    std::optional<Found> found_;  // of it
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace lumulus::service
