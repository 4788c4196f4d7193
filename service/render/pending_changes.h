#pragma once

#include <algorithm>
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
        // where single clouds change, or have changed just before, and nothing can be known beforehand:
        std::vector<CloudEdit> edits{};          ///< of clouds
        bool named = false;                      ///< whether one cloud is meant by `reference`
        CloudReference reference{};              ///< whose extinction or place changes
        std::optional<std::uint64_t> request{};  ///< that is answered when the change is made
        std::optional<NewDensity> density{};     ///< that is prepared then; the answer comes when it is shown
    };

    void add(Change change) { changes_.push_back(std::move(change)); }
    bool any() const { return !changes_.empty(); }
    /// Whether a client waits for a change: a picture that it asks for afterwards shows it.
    bool anyOf(ClientId client) const {
        return std::ranges::any_of(changes_, [client](const Change& change) { return change.client == client; });
    }
    /// Whether clouds of a client's scene are to change, or change now: what there will be nobody knows yet.
    bool editsOf(ClientId client) const {
        return std::ranges::find(editing_, client) != editing_.end() ||
               std::ranges::any_of(changes_, [client](const Change& change) {
                   return change.client == client && !change.edits.empty();
               });
    }
    /// All of them, in the order in which they came; each is made now, and made() is told of it.
    std::vector<Change> takeAll() {
        return takeWhere([](const Change&) { return true; });
    }
    /// Those for which `wanted` returns true; the others stay.
    template <class Condition>
    std::vector<Change> takeWhere(const Condition& wanted) {
        std::vector<Change> taken, left;
        for (Change& change : changes_) (wanted(change) ? taken : left).push_back(std::move(change));
        changes_ = std::move(left);
        for (const Change& change : taken) {
            if (!change.edits.empty()) editing_.push_back(change.client);
            if (change.density) asking_.emplace_back(change.client, *change.request);
        }
        return taken;
    }
    /// Ends a change of density that nobody prepares yet. Returns whether there was one: it is not answered.
    bool cancel(ClientId client, std::uint64_t request) {
        const auto isIt = [&](const Change& change) {
            return change.density && change.client == client && change.request == request;
        };
        return std::erase_if(changes_, isIt) > 0 || std::erase(asking_, std::pair(client, request)) > 0;
    }
    /// Ends all of them of a client. Returns their requests, which are not answered.
    std::vector<std::uint64_t> cancelDensities(ClientId client) {
        std::vector<std::uint64_t> requests;
        std::erase_if(changes_, [&](const Change& change) {
            if (!change.density || change.client != client) return false;
            requests.push_back(*change.request);
            return true;
        });
        std::erase_if(asking_, [&](const auto& asked) {
            if (asked.first == client) requests.push_back(asked.second);
            return asked.first == client;
        });
        return requests;
    }
    /// Whether a change of density that was taken waits for its answer here: nobody prepares it, nor has cancelled it.
    bool wants(const Change& change) const {
        return std::ranges::find(asking_, std::pair(change.client, *change.request)) != asking_.end();
    }
    /// A change that was taken is made, or was refused.
    void made(const Change& change) {
        if (change.density) std::erase(asking_, std::pair(change.client, *change.request));
        const auto found = change.edits.empty() ? editing_.end() : std::ranges::find(editing_, change.client);
        if (found != editing_.end()) editing_.erase(found);
    }
    /// The light of a scene when its changes are made.
    SceneLight after(SceneLight light, const SlotPointer& slot) const;

  private:
    std::vector<Change> changes_;
    std::vector<std::pair<ClientId, std::uint64_t>> asking_;  ///< for densities, by changes that were taken
    std::vector<ClientId> editing_;  ///< a client for each change of clouds that was taken and is not made yet
};

}  // namespace lumulus::service
