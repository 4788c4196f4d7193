#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "service/render/ambient_desk.h"
#include "service/render/bias_desk.h"
#include "service/render/density_desk.h"
#include "service/render/encoding_desk.h"
#include "service/render/fog_desk.h"
#include "service/render/frame_maker.h"
#include "service/render/frame_task.h"
#include "service/render/heartbeat.h"
#include "service/render/light_desk.h"
#include "service/render/pending_changes.h"
#include "service/render/query_desk.h"
#include "service/render/render_config.h"
#include "service/render/scene_desk.h"
#include "service/render/scene_store.h"
#include "service/render/scheduler.h"
#include "service/telemetry/instruments.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Draws frames for many clients on a thread of its own, which owns the renderers and traces photons while nobody asks;
/// others load scenes. Every request gets one answer, a stream many. Pictures are handed over as values, to be
/// encoded elsewhere.
class RenderService {
  public:
    struct Outlets {
        /// Takes an answer that is no picture. Called on any thread while the service is locked, so that answers come
        /// in the order of what they tell: it must not call the service.
        std::function<void(ClientId, std::uint64_t id, Reply)> reply;
        /// Takes a drawn picture, which is to be given back by finish() or failEncoding(). Called on the render thread.
        std::function<void(FrameTask)> encode;
        /// Told once that the default scene is there, or what is wrong with it. Called on a thread of its own.
        std::function<void(std::exception_ptr)> begun;
        /// Pictures that may be with `encode` at once; nothing more is drawn until one comes back.
        std::size_t mostEncoding = 1;
    };

    /// Reads the default scene, and begins to load it: clients that come before it is there wait for it. `config` and
    /// `instruments` must outlive the service. Errors: InputError for a scene file that is not there or is wrong.
    RenderService(const RenderConfig& config, Instruments& instruments, Outlets outlets);
    RenderService(const RenderService&) = delete;
    RenderService& operator=(const RenderService&) = delete;
    /// Ends the threads after the work at hand.
    ~RenderService();

    void addClient(ClientId client);
    void removeClient(ClientId client);
    /// Takes a request for pictures, scenes or their changes, and the memory that it holds. Errors: RequestError.
    void submit(ClientId client, std::uint64_t id, RenderRequest request, MemoryBudget::Share memory = {});
    /// A picture is encoded. Calls `send`, while the service is locked, where its client still waits for it.
    void finish(const FrameTask& task, const EncodingReport& report, const std::function<void()>& send);
    /// A picture could not be encoded.
    void failEncoding(const FrameTask& task, const Failure& failure);
    /// A picture has left for its client.
    void frameSent(ClientId client);
    /// State of the scene that the client sees; none where it sees none.
    std::optional<SceneState> sceneState(ClientId client);
    /// How far the scene is that the client loads; none where it loads none.
    std::optional<LoadState> loadState(ClientId client) const { return desk_.state(client); }

    /// Why the service is not ready to draw: its default scene is not there, it ends, or the render thread does not
    /// move. None where it is ready.
    std::optional<std::string> notReady();
    /// Whether the render thread moves.
    bool alive() const;

    /// Refuses new requests, ends streams, gives up loads, and finishes the frames that wait, drawn with the photons
    /// that are there; those that are not done after `shutdownSeconds` fail with `shutting_down`. Returns when all is
    /// answered; the threads may still be at work.
    void shutDown();

  private:
    void renderLoop();
    double step(const SceneSlot& slot);

    void answer(ClientId client, std::uint64_t id, const StopStream& stop);
    void answer(ClientId client, std::uint64_t id, const Cancel& cancel);
    void answer(ClientId client, std::uint64_t id, Change change, const std::shared_ptr<MemoryBudget::Share>& memory);
    void answer(QueryJob query);
    void submitFrame(Job job);
    void handQueries();
    void measure(const SlotPointer& slot);
    void keepBias();
    SceneDesk::Host deskHost();
    void wakeAll();

    const RenderConfig& config_;
    Metrics& metrics_;
    Outlets outlets_;
    Heartbeat heartbeat_;

    std::mutex mutex_;  // guards what follows; slots' insides belong to the render thread once they are held
    std::condition_variable wake_, idle_;
    Scheduler scheduler_;
    SceneStore scenes_;
    PendingChanges changes_;
    EncodingDesk encoding_;
    QueryDesk queries_;
    AmbientDesk ambient_;
    bool rendering_ = false;  // the render thread is at a picture
    bool closing_ = false, stopping_ = false;

    LightDesk lights_;
    DensityDesk densities_;
    FogDesk fogs_;
    BiasDesk bias_;
    FrameMaker maker_;  // for the render thread
    SceneDesk desk_;    // its threads take the service's lock
    std::thread renderThread_;
};

}  // namespace lumulus::service
