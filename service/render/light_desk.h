#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>

#include "service/render/render_config.h"
#include "service/render/scene_store.h"
#include "service/telemetry/instruments.h"
#include "service/values/results.h"

namespace lumulus::service {

/// Gives clients who change the light of a scene light of their own, so that nobody changes what others see. The scene
/// as it was loaded stays for those who do not; density and programs are shared.
class LightDesk {
  public:
    struct Host {
        std::mutex& mutex;  ///< guards `scenes` and what is kept here
        SceneStore& scenes;
        /// Called with a slot between the steps of all work on it. Returns the seconds of the next.
        std::function<double(const SceneSlot&)> step;
    };

    /// `config` and `instruments` must outlive this.
    LightDesk(const RenderConfig& config, Instruments& instruments, Host host)
        : config_(config), instruments_(instruments), host_(std::move(host)) {}

    // With the lock held:

    /// Sets a light aside for a client who is going to change that of `slot`, the scene that it sees, if it needs one.
    /// Returns whether it does. Errors: RequestError `busy` where there is no room for another.
    bool promise(ClientId client, const SlotPointer& slot, const LightChange& change, std::optional<std::size_t> cloud);
    /// The same for a change of the fog.
    void promiseFog(ClientId client, const SlotPointer& slot);
    /// What went wrong with the client's light since it was told last.
    std::optional<Failure> takeFailure(ClientId client);
    void noteFailure(ClientId client, Failure failure) { failures_[client] = std::move(failure); }
    void removeClient(ClientId client) { failures_.erase(client); }

    // On the render thread, without the lock:

    /// The scene whose light is to be changed where `client`, who sees `slot`, changes it: one of its own, which is
    /// made now if need be, or `slot` where nothing changes. Errors: RequestError `busy`.
    SlotPointer toChange(ClientId client, const SlotPointer& slot, const LightChange& change,
                         std::optional<std::size_t> cloud);

    /// A scene whose light belongs to `client`, who sees `slot`; `slot` where clients share light.
    SlotPointer toOwn(ClientId client, const SlotPointer& slot);

    /// Gives a client, who sees `shown`, a scene of its own with the clouds of `edited`, those of shown->sceneNow(): it
    /// sees that from now on. Errors: RequestError `busy`; `too_large` where the photon map has no room.
    SlotPointer edit(ClientId client, const SlotPointer& shown, const EditedClouds& edited);

  private:
    SlotPointer keepMade(ClientId client, const SlotPointer& own);
    SlotPointer make(ClientId client, const SlotPointer& slot, const EditedClouds* edited);
    bool needsOwn(ClientId client, const SlotPointer& slot, const LightChange& change,
                  std::optional<std::size_t> cloud) const;

    const RenderConfig& config_;
    Instruments& instruments_;
    Host host_;
    std::map<ClientId, Failure> failures_;
};

}  // namespace lumulus::service
