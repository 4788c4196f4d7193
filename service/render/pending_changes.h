#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "service/render/scene_store.h"

namespace lumulus::service {

/// Changes of light that clients were promised and the render thread has yet to make. The caller locks.
class PendingChanges {
  public:
    struct Change {
        ClientId client = 0;
        SlotPointer slot;  ///< the scene that the client saw when it asked
        LightChange light;
        std::optional<std::size_t> cloud;  ///< whose extinction changes; none: all
        bool toOwn = false;                ///< the client gets light of its own by it
    };

    void add(Change change) { changes_.push_back(std::move(change)); }
    bool any() const { return !changes_.empty(); }
    /// All of them, in the order in which they came; they are forgotten.
    std::vector<Change> takeAll() { return std::exchange(changes_, {}); }
    /// Those for which `wanted` returns true; the others stay.
    template <class Condition>
    std::vector<Change> takeWhere(const Condition& wanted) {
        std::vector<Change> taken, left;
        for (Change& change : changes_) (wanted(change) ? taken : left).push_back(std::move(change));
        changes_ = std::move(left);
        return taken;
    }
    /// The light of a scene when its changes are made.
    SceneLight after(SceneLight light, const SlotPointer& slot) const;

  private:
    std::vector<Change> changes_;
};

}  // namespace lumulus::service
