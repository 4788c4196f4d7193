#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "service/render/scene_slot.h"

namespace lumulus::service {

using SlotPointer = std::shared_ptr<SceneSlot>;

/// The scenes that are held in memory, and which of them each client sees. What the render thread tells of a scene by
/// publish() is known here to the other threads. The caller locks.
class SceneStore {
  public:
    /// Holds `most` scenes at most.
    explicit SceneStore(std::uint32_t most) : most_(most) {}

    /// The client sees the default scene, where there is one.
    void addClient(ClientId client) { shownTo_[client] = default_; }
    void removeClient(ClientId client) { shownTo_.erase(client); }
    bool knows(ClientId client) const { return shownTo_.contains(client); }
    void show(ClientId client, SlotPointer slot) { shownTo_[client] = std::move(slot); }
    /// The scene that a client sees; null where it has none.
    SlotPointer shownTo(ClientId client) const;

    void setDefault(SlotPointer slot) { default_ = std::move(slot); }
    /// Clients that see no scene.
    std::vector<ClientId> withoutScene() const;
    bool hasDefault() const { return default_ != nullptr; }
    /// A scene by its key; null where it is not held.
    SlotPointer find(const std::string& key) const;
    bool holds(const SlotPointer& slot) const;
    /// Takes a scene. Where there are too many, the oldest that nobody sees goes, and is returned: it takes its time to
    /// end, so let it end without the lock. Errors: RequestError `busy` where all are seen.
    SlotPointer keep(const SlotPointer& slot);
    /// Forgets the oldest scene that nobody sees, and returns it; null where there is none.
    SlotPointer dropUnseen();
    /// Forgets a scene; its clients have none any more.
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
    /// a step before a picture is `due`, or if it starves. Null where there is none. Only the thread that may use the
    /// scenes calls this.
    SlotPointer toRefine(Clock::time_point now, std::optional<Clock::time_point> due) const;
    /// Whether a scene has to get a generation, however busy streams keep the service.
    static bool starves(const SceneSlot& slot, Clock::time_point now);

  private:
    struct Published {
        std::uint64_t revision = 0;
        SceneState state;
    };

    bool seen(const SlotPointer& slot) const;
    const Published* published(ClientId client) const;

    std::uint32_t most_;
    std::deque<SlotPointer> slots_;  // least recently loaded first
    SlotPointer default_;
    std::map<ClientId, SlotPointer> shownTo_;
    std::map<std::string, Published> published_;  // by key
};

}  // namespace lumulus::service
