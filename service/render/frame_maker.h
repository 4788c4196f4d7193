#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "service/render/encoding_desk.h"
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
        std::mutex& mutex;  ///< guards the next seven
        Scheduler& scheduler;
        SceneStore& scenes;
        PendingChanges& changes;
        EncodingDesk& encoding;
        SceneDesk& scenesToCome;
        LightDesk& lights;
        const bool& closing;
        /// Takes an answer that is no picture, with the lock held.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// Takes a drawn picture, without the lock.
        std::function<void(FrameTask)> encode;
    };

    FrameMaker(Instruments& instruments, Host host);

    /// Makes the changes that clients were promised, and learns what encoding cost.
    void applyChanges();
    /// Draws the picture and hands it over, or puts the job back after a generation.
    void make(Job job);
    /// Traces a generation of photons, or completes a part of the sun's shadow volume.
    void refine(const SlotPointer& slot, bool generation);
    /// Between the steps of work on `slot`: changes light, and makes a picture that is due, of other scenes or, between
    /// the rounds of a generation, of this one. Returns the seconds that the next step should take.
    double interject(const SceneSlot& slot);

  private:
    void apply(const std::vector<PendingChanges::Change>& changes);
    double untilDue();
    void makeFrame(Job job, const FrameRequest& frame, SlotPointer slot);
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
    std::vector<const SceneSlot*> busy_;  // on which work is under way, the outermost first
};

}  // namespace lumulus::service
