#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "service/render/scene_slot.h"

namespace lumulus::service {

using SlotPointer = std::shared_ptr<SceneSlot>;

/// The scenes that are held in memory, and which of them each client sees. What the render thread tells of a scene by
/// publish() is known here to the other threads. The caller locks.
class SceneStore {
  public:
    /// Holds `most` scenes at most, and `mostOwn` lights of clients' own.
    SceneStore(std::uint32_t most, std::uint32_t mostOwn) : most_(most), mostOwn_(mostOwn) {}

    /// The client sees the default scene, where there is one.
    void addClient(ClientId client) { shownTo_[client] = default_; }
    void removeClient(ClientId client);
    bool knows(ClientId client) const { return shownTo_.contains(client); }
    /// The client sees this scene from now on; its own light of another one goes.
    void show(ClientId client, SlotPointer slot);
    /// The scene that a client sees, with the client's own light where it has one; null where it has none.
    SlotPointer shownTo(ClientId client) const;

    /// Sets a light aside for the client. Errors: RequestError `busy` where there are too many.
    void promiseOwn(ClientId client);
    /// Forgets a light that was promised and cannot be made.
    void breakPromise(ClientId client) {
        if (const auto it = own_.find(client); it != own_.end() && !it->second) own_.erase(it);
    }
    /// The client's own light of a scene; null where it has none.
    SlotPointer ownOf(ClientId client, const SlotPointer& source) const;
    /// Takes the light that was promised to its owner, who sees it from now on.
    void keepOwn(const SlotPointer& slot);
    /// Nobody sees this any more.
    void retire(SlotPointer slot) { retired_.push_back(std::move(slot)); }
    /// Lights that nobody sees any more. Let them end on the thread that uses scenes, without the lock.
    std::vector<SlotPointer> takeRetired() { return std::exchange(retired_, {}); }

    void setDefault(SlotPointer slot) { default_ = std::move(slot); }
    /// Clients that see this scene under this light.
    std::vector<ClientId> clientsOf(const SlotPointer& slot) const;
    /// Clients that see no scene.
    std::vector<ClientId> withoutScene() const;
    bool hasDefault() const { return default_ != nullptr; }
    bool isDefault(const SlotPointer& slot) const { return default_ != nullptr && default_ == slot; }
    /// A scene by its key; null where it is not held.
    SlotPointer find(const std::string& key) const;
    bool holds(const SlotPointer& slot) const;
    /// Takes a scene. Where there are too many, the oldest that nobody sees goes, and is returned: it takes its time to
    /// end, so let it end without the lock. Errors: RequestError `busy` where all are seen.
    SlotPointer keep(const SlotPointer& slot);
    /// Forgets the oldest scene that nobody sees, and returns it; null where there is none.
    SlotPointer dropUnseen();
    /// Forgets a scene; its clients have none any more. Forgets a client's own light; the client sees the scene as it
    /// was loaded again.
    void drop(const SlotPointer& slot);
    std::size_t size() const { return slots_.size(); }

    /// Notes state and revision of a scene that is held. Only the thread that may use the scene calls this.
    void publish(const SceneSlot& slot);
    /// Revision of the scene that a client sees; 0 where it has none.
    std::uint64_t revision(ClientId client) const;
    std::optional<SceneState> state(ClientId client) const;
    /// State of a scene; none where it is not held.
    std::optional<SceneState> stateOf(const SceneSlot& slot) const;

    /// Of the scenes that are seen and can be refined, the one whose photons have waited longest, if there is time for
    /// a step before a picture is `due`, or if it starves. The default scene, which newcomers will see, is one of them
    /// where no picture is due. Null where there is none. Only the thread that may use the scenes calls this.
    SlotPointer toRefine(Clock::time_point now, std::optional<Clock::time_point> due) const;
    /// Of the scenes that are seen, the one the error of whose pictures is to be measured first, and when; null where
    /// there is none. As above.
    std::pair<SlotPointer, Clock::time_point> toMeasure() const;
    /// Whether a scene has to get a generation, however busy streams keep the service.
    static bool starves(const SceneSlot& slot, Clock::time_point now);

  private:
    struct Published {
        std::uint64_t revision = 0;
        SceneState state;
    };

    bool seen(const SlotPointer& slot) const;
    bool watched(const SlotPointer& slot) const;
    void retireOwn(ClientId client);
    const Published* published(ClientId client) const;

    std::uint32_t most_, mostOwn_;
    std::deque<SlotPointer> slots_;  // least recently loaded first
    SlotPointer default_;
    std::map<ClientId, SlotPointer> shownTo_;  // without clients' own lights
    std::map<ClientId, SlotPointer> own_;      // null: promised
    std::vector<SlotPointer> retired_;
    std::map<std::string, Published> published_;  // by key
};

/// Calls `taken` until it has found its memory, and lets scenes that nobody sees end meanwhile. Without the lock, which
/// guards the store. Errors: RequestError `busy` where all are seen.
void makeRoom(std::mutex& mutex, SceneStore& scenes, const std::function<bool()>& taken);

}  // namespace lumulus::service
