#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <vector>

#include "service/net/config.h"
#include "service/render/scene_slot.h"
#include "service/render/scheduler.h"
#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// Makes frames for many clients on two threads of its own: one loads scenes, one owns the renderers and draws, and
/// refines photons while nobody asks. Every request gets one reply (streams many), handed to `deliver` on any thread.
class RenderService {
  public:
    /// `frame`: a picture, whose departure is to be told by frameSent(). Must not call the service: some replies come
    /// while it is locked, so that they come in the order of what they tell.
    using Deliver = std::function<void(ClientId client, Message reply, bool frame)>;

    /// Loads the default scene. `config` and `metrics` must outlive the service.
    /// Errors: those of the scene, as InputError or Error.
    RenderService(const Config& config, Metrics& metrics, Deliver deliver);
    RenderService(const RenderService&) = delete;
    RenderService& operator=(const RenderService&) = delete;
    /// Ends the threads after the work at hand.
    ~RenderService();

    void addClient(ClientId client);
    void removeClient(ClientId client);
    /// Takes a request for pictures, scenes or their changes. Errors: RequestError.
    void submit(ClientId client, std::uint64_t id, Request request);
    void frameSent(ClientId client);
    /// What the client's scene is up to.
    nlohmann::json statistics(ClientId client);

    /// Refuses what comes, ends streams, gives up loads, and finishes the frames that wait, drawn with the photons that
    /// are there; what is not done after shutdown_seconds fails with `shutting_down`. Returns when all is answered; the
    /// threads may be at work still.
    void shutDown();

  private:
    using SlotPointer = std::shared_ptr<SceneSlot>;
    struct LoadJob {
        ClientId client = 0;
        std::uint64_t id = 0;
        LoadScene load;
    };

    void loadLoop();
    void load(const LoadJob& job);
    SlotPointer findSlot(const std::string& key);
    void keepSlot(const SlotPointer& slot);
    bool endLoad(const LoadJob& job);
    void finishLoad(const LoadJob& job, const SlotPointer& slot);
    void failLoad(const LoadJob& job, const std::string& code, const std::string& text, const std::string& where = {});

    void renderLoop();
    void make(Job job);
    void makeFrame(Job job, const FrameRequest& frame, const SlotPointer& slot);
    void leaveOut(const Job& job);
    void handOver(const Job& job, SceneSlot::Frame frame);
    void fail(const Job& job, const std::string& code, const std::string& text, const std::string& where = {});
    void dropSlot(const SlotPointer& slot, const char* event, const std::string& why);
    void applyChanges();
    SlotPointer slotToRefine(Clock::time_point now, std::optional<Clock::time_point> due);
    void refine(const SlotPointer& slot, bool generation);
    void publish(const SceneSlot& slot);
    std::uint64_t revisionOf(ClientId client) const;
    SlotPointer slotOf(ClientId client);

    const Config& config_;
    Metrics& metrics_;
    Deliver deliver_;

    std::mutex mutex_;  // guards what follows; slots' insides belong to the render thread once they are published
    std::condition_variable wake_, loadWake_, idle_;
    Scheduler scheduler_;
    std::map<ClientId, SlotPointer> slotOfClient_;
    std::deque<SlotPointer> slots_;  // least recently loaded first
    SlotPointer defaultSlot_;
    std::map<std::string, std::string> states_;       // of slots by key, as JSON
    std::map<std::string, std::uint64_t> revisions_;  // of slots by key
    std::vector<std::pair<SlotPointer, LightChange>> changes_;
    std::deque<LoadJob> loads_;
    std::optional<LoadJob> loading_;  // that the load thread is at, and its client waits for
    bool rendering_ = false;          // the render thread is at a picture
    bool closing_ = false, stopping_ = false;
    std::atomic<bool> abandon_{false};  // ends a load under way

    std::thread renderThread_, loadThread_;
};

}  // namespace lumulus::service
