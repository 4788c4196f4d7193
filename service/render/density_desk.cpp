#include "service/render/density_desk.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

/// Moves what fulfils a condition out of a list.
template <class Entry, class Condition>
std::vector<Entry> takeFrom(std::vector<Entry>& list, const Condition& condition) {
    std::vector<Entry> taken, left;
    for (Entry& entry : list) (condition(entry) ? taken : left).push_back(std::move(entry));
    list = std::move(left);
    return taken;
}

}  // namespace

/// With the lock held. Errors: RequestError where the client does not see the scene any more that gets the density.
SlotPointer DensityDesk::shownFor(const LoadJob& job) const {
    SlotPointer shown = host_.scenes.shownTo(job.client);
    if (!shown) throw RequestError("no_scene", "the scene is gone: load one");
    if (shown->scene().clouds != job.density->shown.scene.clouds)
        throw RequestError("superseded", "the clouds have come or gone meanwhile: ask again");
    return shown;
}

/// With the lock held: whether the scene of before is at a step at which it can change.
bool DensityDesk::canBegin(const LoadJob& job) const {
    const SlotPointer shown = host_.scenes.shownTo(job.client);
    return !shown || shown->canChange();
}

void DensityDesk::add(const LoadJob& job, SlotPointer slot, DensityChanged changed) {
    ready_.push_back({job, std::move(slot), std::move(changed)});
}

template <class Condition>
std::vector<LoadJob> DensityDesk::takeWhere(const Condition& condition) {
    std::vector<LoadJob> jobs;
    for (Ready& ready : takeFrom(ready_, [&](const Ready& one) { return condition(one.job); })) {
        host_.scenes.retire(std::move(ready.slot));
        jobs.push_back(std::move(ready.job));
    }
    return jobs;
}

std::vector<LoadJob> DensityDesk::take(ClientId client, std::optional<std::uint64_t> id) {
    return takeWhere([&](const LoadJob& job) { return job.client == client && (!id || job.id == *id); });
}

std::vector<LoadJob> DensityDesk::takeAll() {
    return takeWhere([](const LoadJob&) { return true; });
}

/// Lets the render thread do work on the scene that the client sees. Both own the work, which may go on where `check`
/// throws.
void DensityDesk::ask(const LoadJob& job, const std::function<void()>& check, std::function<void(SceneSlot&)> work) {
    constexpr auto pause = std::chrono::milliseconds(5);
    const auto asked = std::make_shared<Asked>();
    asked->job = job;
    asked->work = std::move(work);
    std::future<void> answer = asked->answer.get_future();
    {
        const std::lock_guard lock(host_.mutex);
        asked_.push_back(asked);
    }
    host_.wake();
    try {
        while (answer.wait_for(pause) != std::future_status::ready) check();
    } catch (...) {
        const std::lock_guard lock(host_.mutex);
        std::erase(asked_, asked);
        throw;
    }
    answer.get();
}

/// Errors: RequestError `busy`.
MemoryBudget::Share DensityDesk::roomFor(std::uint64_t bytes) {
    std::optional<MemoryBudget::Share> share;
    makeRoom(host_.mutex, host_.scenes, [&] {
        share = instruments_.memory.take(MemoryBudget::scenes, bytes);
        return share.has_value();
    });
    return std::move(*share);
}

SceneBefore DensityDesk::before(const LoadJob& job, const std::function<void()>& check) {
    const auto before = std::make_shared<SceneBefore>();
    ask(job, check, [this, before](SceneSlot& shown) {
        MemoryBudget::Share memory = roomFor(2 * shown.lightBytes());  // as it was, and as it goes on
        *before = shown.before();
        before->memory = std::move(memory);
    });
    return std::move(*before);
}

DensitiesBefore DensityDesk::densities(const LoadJob& job, const scene::Scene& next,
                                       const std::function<void()>& check) {
    struct Copies {
        DensitiesBefore result;
        scene::Scene next;
        bool begun = false, done = false;
    };
    constexpr std::uint64_t piece = std::uint64_t{8} << 20U;  // bytes: some milliseconds between two pictures
    constexpr auto pause = std::chrono::milliseconds(2);      // for pictures
    const auto copies = std::make_shared<Copies>();
    copies->next = next;
    while (!copies->done) {
        ask(job, check, [this, copies](SceneSlot& shown) {
            if (!std::exchange(copies->begun, true))
                copies->result.memory = roomFor(shown.densities().copyBytes(copies->next));
            copies->done = shown.densities().copy(copies->next, copies->result.copies, piece);
        });
        if (!copies->done) std::this_thread::sleep_for(pause);
    }
    return std::move(copies->result);
}

void DensityDesk::work() {
    std::vector<std::shared_ptr<Asked>> asked;
    std::vector<Ready> ready;
    {
        const std::lock_guard lock(host_.mutex);
        asked = takeFrom(asked_, [this](const auto& one) { return canBegin(one->job); });
        ready = takeFrom(ready_, [this](const Ready& one) { return canBegin(one.job); });
    }
    for (const auto& one : asked) tell(*one);
    for (Ready& one : ready) show(one);
}

void DensityDesk::tell(Asked& asked) {
    try {
        SlotPointer shown;
        {
            const std::lock_guard lock(host_.mutex);
            shown = shownFor(asked.job);
        }
        asked.work(*shown);
        asked.answer.set_value();
    } catch (...) {
        asked.answer.set_exception(std::current_exception());
    }
}

void DensityDesk::show(Ready& ready) {
    const LoadJob& job = ready.job;
    Failure failure;
    try {
        SlotPointer shown;
        {
            const std::lock_guard lock(host_.mutex);
            shown = shownFor(job);
            host_.scenes.promiseOwn(job.client);
        }
        ready.slot->takePlaceOf(shown, job.client);
        ready.slot->onStep([step = host_.step, raw = ready.slot.get()] { return step(*raw); });
        ready.changed.scene = ready.slot->description();
        ready.changed.photons = ready.slot->state().photons;
        instruments_.log.event("info", "density_shown", {{"client", job.client}, {"scene", shown->scene().source}});
        const std::lock_guard lock(host_.mutex);
        host_.scenes.keepOwn(ready.slot);
        host_.reply(job.client, job.id, std::move(ready.changed));
        return;
    } catch (const RequestError& e) {
        failure = {e.code, e.what(), e.where};
    } catch (const InputError& e) {
        failure = {"bad_request", e.what(), {}};
    }
    const std::lock_guard lock(host_.mutex);
    host_.scenes.breakPromise(job.client);
    host_.scenes.retire(std::move(ready.slot));
    host_.reply(job.client, job.id, failure);
}

}  // namespace lumulus::service
