#include "service/render/scene_store.h"

#include <algorithm>

#include "service/values/request_error.h"

namespace lumulus::service {

void SceneStore::removeClient(ClientId client) {
    retireOwn(client);
    shownTo_.erase(client);
}

void SceneStore::show(ClientId client, SlotPointer slot) {
    retireOwn(client);
    shownTo_[client] = std::move(slot);
}

void SceneStore::retireOwn(ClientId client) {
    const auto it = own_.find(client);
    if (it == own_.end()) return;
    if (it->second) {
        published_.erase(it->second->key());
        retired_.push_back(it->second);
    }
    own_.erase(it);
}

void SceneStore::promiseOwn(ClientId client) {
    if (own_.contains(client)) return;
    if (own_.size() >= mostOwn_)
        throw RequestError("busy", "all lights of their own that the service gives to clients (" +
                                       std::to_string(mostOwn_) + ") are in use");
    own_[client] = nullptr;
}

SlotPointer SceneStore::ownOf(ClientId client, const SlotPointer& source) const {
    const auto it = own_.find(client);
    return it != own_.end() && it->second && it->second->source() == source ? it->second : nullptr;
}

void SceneStore::keepOwn(const SlotPointer& slot) {
    const auto shown = shownTo_.find(*slot->owner());
    if (shown == shownTo_.end() || shown->second != slot->source()) {
        retired_.push_back(slot);  // the client has gone, or looks at another scene
        return;
    }
    SlotPointer& own = own_[*slot->owner()];
    if (own) retired_.push_back(own);  // of other clouds
    own = slot;
    publish(*slot);
}

SlotPointer SceneStore::shownTo(ClientId client) const {
    if (const auto own = own_.find(client); own != own_.end() && own->second) return own->second;
    const auto it = shownTo_.find(client);
    return it == shownTo_.end() ? nullptr : it->second;
}

SlotPointer SceneStore::find(const std::string& key) const {
    const auto it = std::ranges::find_if(slots_, [&](const SlotPointer& slot) { return slot->key() == key; });
    return it == slots_.end() ? nullptr : *it;
}

bool SceneStore::holds(const SlotPointer& slot) const {
    return std::ranges::find(slots_, slot) != slots_.end() ||
           std::ranges::any_of(own_, [&](const auto& entry) { return slot && entry.second == slot; });
}

bool SceneStore::seen(const SlotPointer& slot) const {
    return slot == default_ || std::ranges::any_of(shownTo_, [&](const auto& entry) { return entry.second == slot; });
}

/// Whether somebody sees the scene under the light that it was loaded with.
bool SceneStore::watched(const SlotPointer& slot) const {
    return std::ranges::any_of(shownTo_,
                               [&](const auto& entry) { return entry.second == slot && !ownOf(entry.first, slot); });
}

std::vector<ClientId> SceneStore::clientsOf(const SlotPointer& slot) const {
    std::vector<ClientId> clients;
    for (const auto& [client, shown] : shownTo_)
        if (shownTo(client) == slot) clients.push_back(client);
    return clients;
}

std::vector<ClientId> SceneStore::withoutScene() const {
    std::vector<ClientId> clients;
    for (const auto& [client, shown] : shownTo_)
        if (!shown) clients.push_back(client);
    return clients;
}

SlotPointer SceneStore::dropUnseen() {
    const auto unused = std::ranges::find_if_not(slots_, [this](const SlotPointer& one) { return seen(one); });
    if (unused == slots_.end()) return nullptr;
    SlotPointer dropped = *unused;
    drop(dropped);
    return dropped;
}

SlotPointer SceneStore::keep(const SlotPointer& slot) {
    SlotPointer dropped;
    if (slots_.size() >= most_) {
        dropped = dropUnseen();
        if (!dropped)
            throw RequestError("busy", "all " + std::to_string(most_) + " scenes that the service holds are in use");
    }
    slots_.push_back(slot);
    publish(*slot);
    return dropped;
}

void SceneStore::drop(const SlotPointer& slot) {
    if (slot->source()) return retireOwn(*slot->owner());
    std::erase(slots_, slot);
    published_.erase(slot->key());
    for (auto& [client, shown] : shownTo_)
        if (shown == slot) shown = nullptr;
    if (default_ == slot) default_ = nullptr;
}

void SceneStore::publish(const SceneSlot& slot) {
    const auto is = [&](const SlotPointer& one) { return one.get() == &slot; };
    const bool held = std::ranges::any_of(slots_, is) ||
                      std::ranges::any_of(own_, [&](const auto& entry) { return is(entry.second); });
    if (held) published_[slot.key()] = {slot.revision(), slot.state()};
}

const SceneStore::Published* SceneStore::published(ClientId client) const {
    const SlotPointer slot = shownTo(client);
    if (!slot) return nullptr;
    const auto it = published_.find(slot->key());
    return it == published_.end() ? nullptr : &it->second;
}

std::uint64_t SceneStore::revision(ClientId client) const {
    const Published* known = published(client);
    return known == nullptr ? 0 : known->revision;
}

std::optional<SceneState> SceneStore::state(ClientId client) const {
    const Published* known = published(client);
    if (known == nullptr) return std::nullopt;
    SceneState state = known->state;
    const SlotPointer slot = shownTo(client);
    for (const auto& [other, shown] : shownTo_) state.clients += shownTo(other) == slot ? 1U : 0U;
    return state;
}

std::optional<SceneState> SceneStore::stateOf(const SceneSlot& slot) const {
    const auto it = published_.find(slot.key());
    return it == published_.end() ? std::nullopt : std::optional(it->second.state);
}

bool SceneStore::starves(const SceneSlot& slot, Clock::time_point now) {
    constexpr double longestWithoutGeneration = 1000.0;  // milliseconds
    constexpr double shareOfTime = 1.0 / 30.0;           // of a generation, which pictures have to wait for
    const double longest = std::max(longestWithoutGeneration, slot.traceMs() / shareOfTime);
    return slot.wantsGeneration() &&
           std::chrono::duration<double, std::milli>(now - slot.lastTraced()).count() > longest;
}

void makeRoom(std::mutex& mutex, SceneStore& scenes, const std::function<bool()>& taken) {
    while (!taken()) {
        SlotPointer unseen;  // ends after the lock, and gives its memory back
        const std::lock_guard lock(mutex);
        unseen = scenes.dropUnseen();
        if (!unseen) throw RequestError("busy", "there is no memory for another scene now: try again later");
    }
}

SlotPointer SceneStore::toRefine(Clock::time_point now, std::optional<Clock::time_point> due) const {
    SlotPointer best;
    const auto consider = [&](const SlotPointer& slot) {
        if ((slot->wantsGeneration() || slot->wantsSun()) && (!best || slot->lastTraced() < best->lastTraced()))
            best = slot;
    };
    for (const SlotPointer& slot : slots_) {
        const bool forNewcomers = slot == default_ && !due;  // who streams does not wait for them
        if (watched(slot) || forNewcomers) consider(slot);
    }
    for (const auto& [client, slot] : own_)
        if (slot) consider(slot);
    if (!best || !due || starves(*best, now)) return best;
    const double step = best->wantsSun() ? best->sharpenMs() : std::min(best->traceMs(), 1e3 * WorkGuard::shortStep);
    return now + std::chrono::duration<double, std::milli>(step) < std::max(*due, now) ? best : nullptr;
}

std::pair<SlotPointer, Clock::time_point> SceneStore::toMeasure() const {
    std::pair<SlotPointer, Clock::time_point> first{nullptr, Clock::time_point::max()};
    const auto consider = [&](const SlotPointer& slot) {
        if (const auto due = slot->biasDue(); due && *due < first.second) first = {slot, *due};
    };
    for (const SlotPointer& slot : slots_)
        if (watched(slot)) consider(slot);
    for (const auto& [client, slot] : own_)
        if (slot) consider(slot);
    return first;
}

}  // namespace lumulus::service
