#include "service/render/density_desk.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
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

std::vector<LoadJob> DensityDesk::take(ClientId client) {
    return takeWhere([client](const LoadJob& job) { return job.client == client; });
}

std::vector<LoadJob> DensityDesk::takeAll() {
    return takeWhere([](const LoadJob&) { return true; });
}

SceneBefore DensityDesk::before(const LoadJob& job, const std::function<void()>& check) {
    constexpr auto pause = std::chrono::milliseconds(5);
    const auto asked = std::make_shared<Asked>();
    asked->job = job;
    std::future<SceneBefore> answer = asked->answer.get_future();
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
    return answer.get();
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
        asked.answer.set_value(shown->before());
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
