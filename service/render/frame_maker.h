#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "service/render/density_desk.h"
#include "service/render/encoding_desk.h"
#include "service/render/fog_desk.h"
#include "service/render/frame_task.h"
#include "service/render/light_desk.h"
#include "service/render/pending_changes.h"
#include "service/render/scene_desk.h"
#include "service/render/scene_store.h"
#include "service/render/scheduler.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

/// The work of the render thread: changes of light, generations of photons, and pictures from being due to being handed
/// over. While one client's work takes long, pictures of others are made between its steps. All functions are
/// called on the render thread, without the lock.
class FrameMaker {
  public:
    struct Host {
        std::mutex& mutex;  ///< guards the next nine
        Scheduler& scheduler;
        SceneStore& scenes;
        PendingChanges& changes;
        EncodingDesk& encoding;
        SceneDesk& scenesToCome;
        LightDesk& lights;
        DensityDesk& densities;
        FogDesk& fogs;
        const bool& closing;
        /// Takes an answer that is no picture, with the lock held.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// Takes a drawn picture, without the lock.
        std::function<void(FrameTask)> encode;
    };

    FrameMaker(Instruments& instruments, Host host);

    /// Makes the changes that clients were promised, shows the densities and the fog that are ready, and learns what
    /// encoding cost.
    void applyChanges();
    /// Draws the picture and hands it over, or puts the job back after a generation.
    void make(const Job& job);
    /// Traces a generation of photons, or completes a part of the sun's shadow volume.
    void refine(const SlotPointer& slot, bool generation);
    /// Between the steps of work on `slot`: changes light, and makes pictures that are due for as long as the step has
    /// taken. A picture waits for those alone that have taken less than it probably will. Returns the seconds that the
    /// next step should take.
    double interject(const SceneSlot& slot);

  private:
    /// That is under way on a slot.
    struct Work {
        const SceneSlot* slot;
        Clock::time_point begun, lastStep;
        Clock::duration othersBefore;
    };
    class Busy;
    /// Milliseconds since, but for what was done for others between the steps.
    double workedSince(Clock::time_point begun, Clock::duration othersBefore) const;
    bool makeOther(double limit);
    void applyBetween();
    void apply(const std::vector<PendingChanges::Change>& changes);
    void prepare(const PendingChanges::Change& change, const SlotPointer& shown);
    void makeChange(const PendingChanges::Change& change);
    void changeLight(ClientId client, const SlotPointer& slot, const LightChange& light,
                     std::optional<std::size_t> cloud);
    double untilDue();
    void makeFor(const Job& job, SlotPointer slot, bool closing);
    void makeFrame(Job job, const FrameRequest& frame, SlotPointer slot);
    void putBack(const Job& job, const SlotPointer& slot);
    void waitFor(const Job& job, const SlotPointer& slot);
    void trace(const SlotPointer& slot, bool generation);
    void leaveOut(const Job& job);
    void handOver(const Job& job, std::variant<FrameResult, CompositeResult> result, const SlotPointer& slot,
                  MemoryBudget::Share memory);
    void fail(const Job& job, const Failure& failure);
    bool bringBack(const SlotPointer& slot, const char* event, const TooSlow& error);
    void dropSlot(const SlotPointer& slot, const char* event, const std::string& why);
    MemoryBudget::Share roomFor(std::uint64_t bytes);
    void publish(const SceneSlot& slot);

    Metrics& metrics_;
    EventLog& log_;
    MemoryBudget& memory_;
    Host host_;
    std::vector<Work> busy_;         // the outermost first
    std::vector<ClientId> waiting_;  // whose picture cannot be made between the steps of the work that is under way
    Clock::duration others_{};       // for others, between the steps of the work that is under way
};

}  // namespace lumulus::service
