#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "service/render/frame_task.h"
#include "service/render/render_config.h"
#include "service/render/scene_loader.h"
#include "service/render/scene_store.h"
#include "service/render/scheduler.h"
#include "service/telemetry/metrics.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Draws frames for many clients on a thread of its own, which owns the renderers and traces photons while nobody asks;
/// another thread loads scenes. Every request gets one answer, a stream many. Pictures are handed over as values, to be
/// encoded elsewhere.
class RenderService {
  public:
    struct Outlets {
        /// Takes an answer that is no picture. Called on any thread while the service is locked, so that answers come
        /// in the order of what they tell: it must not call the service.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// Takes a drawn picture, which is to be given back by finish() or failEncoding(). Called on the render thread.
        std::function<void(FrameTask)> encode;
        /// Pictures that may be with `encode` at once; nothing more is drawn until one comes back.
        std::size_t mostEncoding = 1;
    };

    /// Loads the default scene. `config` and `metrics` must outlive the service.
    /// Errors: those of the scene, as InputError or Error.
    RenderService(const RenderConfig& config, Metrics& metrics, Outlets outlets);
    RenderService(const RenderService&) = delete;
    RenderService& operator=(const RenderService&) = delete;
    /// Ends the threads after the work at hand.
    ~RenderService();

    void addClient(ClientId client);
    void removeClient(ClientId client);
    /// Takes a request for pictures, scenes or their changes. Errors: RequestError.
    void submit(ClientId client, std::uint64_t id, RenderRequest request);
    /// A picture is encoded. Calls `send`, while the service is locked, where its client still waits for it.
    void finish(const FrameTask& task, const EncodingReport& report, const std::function<void()>& send);
    /// A picture could not be encoded.
    void failEncoding(const FrameTask& task, const Failure& failure);
    /// A picture has left for its client.
    void frameSent(ClientId client);
    /// State of the scene that the client sees; none where it sees none.
    std::optional<SceneState> sceneState(ClientId client);
    /// How far the scene is that the client loads; none where it loads none.
    std::optional<LoadState> loadState(ClientId client) const { return loader_.state(client); }

    /// Refuses new requests, ends streams, gives up loads, and finishes the frames that wait, drawn with the photons
    /// that are there; those that are not done after `shutdownSeconds` fail with `shutting_down`. Returns when all is
    /// answered; the threads may still be at work.
    void shutDown();

  private:
    void renderLoop();
    void make(Job job);
    void makeFrame(Job job, const FrameRequest& frame, const SlotPointer& slot);
    void leaveOut(const Job& job);
    void handOver(const Job& job, std::variant<FrameResult, CompositeResult> result, const SlotPointer& slot);
    void fail(const Job& job, const Failure& failure);
    void dropSlot(const SlotPointer& slot, const char* event, const std::string& why);
    void applyChanges();
    bool encodersFull(std::optional<Clock::time_point> due, Clock::time_point now);
    void refine(const SlotPointer& slot, bool generation);

    void answer(ClientId client, std::uint64_t id, const StopStream& stop);
    void answer(ClientId client, std::uint64_t id, const Cancel& cancel);
    void answer(ClientId client, std::uint64_t id, Change change);
    void submitFrame(Job job);
    SceneLoader::Host loaderHost();
    void keepSlot(const SlotPointer& slot);
    void loaded(const SceneLoader::LoadJob& job, const SlotPointer& slot);
    void loadFailed(const SceneLoader::LoadJob& job, const Failure& failure);

    const RenderConfig& config_;
    Metrics& metrics_;
    Outlets outlets_;

    std::mutex mutex_;  // guards what follows; slots' insides belong to the render thread once they are held
    std::condition_variable wake_, idle_;
    Scheduler scheduler_;
    SceneStore scenes_;
    /// A change of light that the render thread has yet to make.
    struct PendingChange {
        SlotPointer slot;
        LightChange light;
        std::optional<std::size_t> cloud;  ///< whose extinction changes; none: all
    };
    std::vector<PendingChange> changes_;
    struct EncodingCost {
        std::weak_ptr<SceneSlot> slot;
        Encoding encoding;
        EncodingReport report;
    };
    std::vector<EncodingCost> encodingCosts_;  // for the slots to learn
    std::size_t encoding_ = 0;                 // pictures that are drawn and not given back yet
    bool waitsForEncoders_ = false;
    bool rendering_ = false;  // the render thread is at a picture
    bool closing_ = false, stopping_ = false;

    SceneLoader loader_;  // has a lock of its own, which is taken after the service's
    std::thread renderThread_;
};

}  // namespace lumulus::service
