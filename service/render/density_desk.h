#pragma once

#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "service/render/load_queue.h"
#include "service/render/scene_before.h"
#include "service/render/scene_store.h"
#include "service/telemetry/instruments.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Where scenes with other densities, which loaders prepare, and the render thread, which draws those of before, meet:
/// the one asks for the light to go on with, and the other shows what is ready between two pictures.
class DensityDesk {
  public:
    struct Host {
        std::mutex& mutex;  ///< guards `scenes` and what is kept here
        SceneStore& scenes;
        /// Takes an answer, with the lock held.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// There is work for the render thread. Without the lock.
        std::function<void()> wake;
        /// Called with a slot between the steps of all work on it. Returns the seconds of the next.
        std::function<double(const SceneSlot&)> step;
    };

    DensityDesk(Instruments& instruments, Host host) : instruments_(instruments), host_(std::move(host)) {}

    // With the lock held:

    /// Whether there is work for the render thread.
    bool any() const { return !asked_.empty() || !ready_.empty(); }
    /// Takes a scene that is ready to be shown.
    void add(const LoadJob& job, SlotPointer slot, DensityChanged changed);
    /// Forgets what is ready for a client, or by one request, and returns the jobs, which nobody answers any more.
    std::vector<LoadJob> take(ClientId client, std::optional<std::uint64_t> id = {});
    /// The same of all clients.
    std::vector<LoadJob> takeAll();
    void removeClient(ClientId client) { take(client); }

    // On a loader's thread, without the lock:

    /// The scene that the client sees, to go on with. Calls `check` while it waits, and throws what that throws.
    /// Errors: RequestError where the client sees another scene by now, or none.
    /// RequestError `busy` where there is no memory for the light.
    SceneBefore before(const LoadJob& job, const std::function<void()>& check);
    /// Copies of the densities of that scene which the next one shows too, read piece by piece. Errors: as before().
    DensitiesBefore densities(const LoadJob& job, const scene::Scene& next, const std::function<void()>& check);

    // On the render thread, without the lock:

    /// Answers the loaders, and shows what is ready, where no picture of the scene of before is being drawn.
    void work();

  private:
    /// What a loader wants of the scene that the client sees.
    struct Asked {
        LoadJob job;
        std::function<void(SceneSlot&)> work;
        std::promise<void> answer;
    };
    struct Ready {
        LoadJob job;
        SlotPointer slot;
        DensityChanged changed;
    };

    SlotPointer shownFor(const LoadJob& job) const;
    bool canBegin(const LoadJob& job) const;
    void ask(const LoadJob& job, const std::function<void()>& check, std::function<void(SceneSlot&)> work);
    MemoryBudget::Share roomFor(std::uint64_t bytes);
    void tell(Asked& asked);
    void show(Ready& ready);
    template <class Condition>
    std::vector<LoadJob> takeWhere(const Condition& condition);

    Instruments& instruments_;
    Host host_;
    std::vector<std::shared_ptr<Asked>> asked_;
    std::vector<Ready> ready_;
};

}  // namespace lumulus::service
