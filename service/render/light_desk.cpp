#include "service/render/light_desk.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

bool LightDesk::needsOwn(ClientId client, const SlotPointer& slot, const LightChange& change,
                         std::optional<std::size_t> cloud) const {
    if (config_.sharedLight || slot->owner() == client || change.empty()) return false;
    return changesLight(slot->scene(), change, cloud);
}

bool LightDesk::promise(ClientId client, const SlotPointer& slot, const LightChange& change,
                        std::optional<std::size_t> cloud) {
    if (!slot || !needsOwn(client, slot, change, cloud)) return false;
    host_.scenes.promiseOwn(client);
    return true;
}

void LightDesk::promiseFog(ClientId client, const SlotPointer& slot) {
    if (!config_.sharedLight && slot->owner() != client) host_.scenes.promiseOwn(client);
}

std::optional<Failure> LightDesk::takeFailure(ClientId client) {
    const auto it = failures_.find(client);
    if (it == failures_.end()) return std::nullopt;
    std::optional<Failure> failure = std::move(it->second);
    failures_.erase(it);
    return failure;
}

/// Errors: RequestError `busy` where memory runs out.
SlotPointer LightDesk::make(ClientId client, const SlotPointer& slot, const EditedClouds* edited) {
    try {
        // until it is there and counted with the scene's: no more than the scene has itself
        const auto room = instruments_.memory.take(MemoryBudget::scenes, slot->heldBytes());
        if (room) return std::make_shared<SceneSlot>(slot, client, edited);
    } catch (const InputError& e) {
        const std::lock_guard lock(host_.mutex);
        host_.scenes.breakPromise(client);
        throw RequestError("too_large", e.what(), "clouds");
    } catch (const std::exception& e) {
        instruments_.log.event("warning", "light_failed", {{"client", client}, {"message", e.what()}});
    }
    const std::lock_guard lock(host_.mutex);
    host_.scenes.breakPromise(client);
    throw RequestError("busy", "the service has no memory for light of your own now: try again later");
}

SlotPointer LightDesk::toChange(ClientId client, const SlotPointer& slot, const LightChange& change,
                                std::optional<std::size_t> cloud) {
    return needsOwn(client, slot, change, cloud) ? toOwn(client, slot) : slot;
}

SlotPointer LightDesk::toOwn(ClientId client, const SlotPointer& slot) {
    if (config_.sharedLight || slot->owner() == client) return slot;
    {
        const std::lock_guard lock(host_.mutex);
        if (SlotPointer own = host_.scenes.ownOf(client, slot)) return own;
        host_.scenes.promiseOwn(client);
    }
    return keepMade(client, make(client, slot, nullptr));
}

SlotPointer LightDesk::edit(ClientId client, const SlotPointer& shown, const EditedClouds& edited) {
    {
        const std::lock_guard lock(host_.mutex);
        host_.scenes.promiseOwn(client);
    }
    return keepMade(client, make(client, shown, &edited));
}

SlotPointer LightDesk::keepMade(ClientId client, const SlotPointer& own) {
    own->onStep([step = host_.step, raw = own.get()] { return step(*raw); });
    instruments_.log.event("info", "light_made", {{"client", client}, {"scene", own->scene().source}});
    const std::lock_guard lock(host_.mutex);
    host_.scenes.keepOwn(own);
    return own;
}

}  // namespace lumulus::service
