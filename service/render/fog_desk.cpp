#include "service/render/fog_desk.h"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/render/durations.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::ptrdiff_t mostWaiting = 16;  // of one client
constexpr int lowPriority = 10;             // niceness: frames go first

/// Thrown where nobody waits any more.
struct GivenUp {};

/// Whether all that one change gives is given by a newer one.
bool covers(std::span<const MediumEdit> newer, std::span<const MediumEdit> older) {
    return std::ranges::all_of(older, [&](const MediumEdit& edit) {
        const auto same = std::ranges::find(newer, edit.medium, &MediumEdit::medium);
        if (same == newer.end()) return false;
        if (same->original) return true;
        return !edit.original &&
               std::ranges::all_of(edit.keys, [&](const auto& key) { return same->keys.contains(key.first); });
    });
}

/// Key of a scene as it was loaded.
const std::string& keyOf(const SceneSlot& slot) {
    return slot.source() ? slot.source()->key() : slot.key();
}

/// Errors: RequestError.
void requireMedia(std::span<const MediumEdit> edits, std::size_t media) {
    for (std::size_t i = 0; i < edits.size(); ++i)
        if (edits[i].medium >= media)
            throw RequestError("not_found",
                               "there is no medium " + std::to_string(edits[i].medium) + ": the fog of the scene has " +
                                   std::to_string(media),
                               "media[" + std::to_string(i) + "].medium");
}

}  // namespace

FogDesk::FogDesk(const RenderConfig& config, Instruments& instruments, Host host)
    : config_(config), instruments_(instruments), host_(std::move(host)), thread_([this] { loop(); }) {}

void FogDesk::stop() {
    {
        const std::lock_guard lock(host_.mutex);
        stopping_ = true;
        if (begun_) begun_->cancelled.store(true);
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void FogDesk::submit(Asked asked) {
    const auto ofClient = [&](const Asked& other) { return other.client == asked.client; };
    const auto last = std::find_if(asked_.rbegin(), asked_.rend(), ofClient);
    if (last != asked_.rend() && covers(asked.edits, last->edits)) {
        host_.reply(last->client, last->id, Failure{"superseded", "a newer change of the fog takes its place", {}});
        *last = std::move(asked);
        return;
    }
    if (std::ranges::count_if(asked_, ofClient) >= mostWaiting)
        throw RequestError("busy", "so many changes of fog wait already", "media");
    asked_.push_back(std::move(asked));
}

std::vector<FogDesk::Asked> FogDesk::take(std::optional<ClientId> client) {
    std::vector<Asked> taken;
    if (begun_ && client.value_or(this->client()) == this->client()) {
        begun_->cancelled.store(true);
        taken = begun_->asked;
        begun_.reset();
        found_.reset();
    }
    std::erase_if(asked_, [&](Asked& asked) {
        if (asked.client != client.value_or(asked.client)) return false;
        taken.push_back(std::move(asked));
        return true;
    });
    return taken;
}

void FogDesk::giveUp(ClientId client) {
    const std::vector<Asked> taken = take(client);
    if (!taken.empty()) host_.scenes.breakPromise(client);
    for (const Asked& asked : taken)
        host_.reply(client, asked.id, Failure{"superseded", "another scene takes the place of this one", {}});
}

void FogDesk::fail(const Asked& asked, const Failure& failure) {
    instruments_.log.event("warning", "change_refused", {{"client", asked.client}, {"message", failure.text}});
    host_.reply(asked.client, asked.id, failure);
}

/// All that the client asks for who has waited longest, where no picture of its scene is being drawn.
std::vector<FogDesk::Asked> FogDesk::nextToBegin() {
    std::vector<Asked> taken;
    if (begun_ || asked_.empty()) return taken;
    const ClientId client = asked_.front().client;
    const SlotPointer slot = host_.scenes.shownTo(client);
    if (!slot || slot->canChange()) taken = take(client);
    return taken;
}

void FogDesk::work() {
    std::shared_ptr<Job> job;
    Found found;
    {
        const std::lock_guard lock(host_.mutex);
        const SlotPointer shown = found_ ? host_.scenes.shownTo(client()) : nullptr;
        if (found_ && (!shown || shown->canChange())) {
            found = *std::exchange(found_, std::nullopt);
            job = std::exchange(begun_, nullptr);
        }
    }
    if (job) show(*job, found);
    std::vector<Asked> asked;
    {
        const std::lock_guard lock(host_.mutex);
        asked = nextToBegin();
    }
    if (!asked.empty()) begin(std::move(asked));
}

void FogDesk::begin(std::vector<Asked> asked) {
    const auto job = std::make_shared<Job>();
    job->asked = std::move(asked);
    const ClientId client = job->asked.front().client;
    SlotPointer slot;
    {
        const std::lock_guard lock(host_.mutex);
        slot = host_.scenes.shownTo(client);
    }
    Failure failure{"no_scene", "the scene is gone: load one", {}};
    try {
        if (slot) job->maker = slot->fogMaker();
    } catch (const InputError& e) {
        failure = failureOf(e, {});
    }
    const std::lock_guard lock(host_.mutex);
    if (!job->maker) {
        host_.scenes.breakPromise(client);
        for (const Asked& one : job->asked) fail(one, failure);
        return;
    }
    job->scene = keyOf(*slot);
    job->load = slot->load();
    job->lit = !slot->scene().clouds.empty();
    job->media = slot->fogMedia().size();
    job->keys = slot->mediaKeys();
    begun_ = job;
    wake_.notify_all();
}

/// Errors: RequestError.
void FogDesk::put(const Job& job, const Found& found) {
    const ClientId client = job.asked.front().client;
    SlotPointer shown;
    {
        const std::lock_guard lock(host_.mutex);
        shown = host_.scenes.shownTo(client);
    }
    if (!shown || keyOf(*shown) != job.scene)
        throw RequestError("superseded", "another scene has taken the place of this one");
    if (shown->hasFog(*found.fog)) return;
    const auto start = Clock::now();
    shown = host_.lights.toOwn(client, shown);
    shown->apply(*found.fog, found.keys);
    instruments_.log.event("info", "fog_shown",
                           {{"client", client},
                            {"scene", shown->scene().source},
                            {"changes", found.made.size()},
                            {"found_milliseconds", found.milliseconds},
                            {"shown_milliseconds", millisecondsSince(start)}});
    const std::lock_guard lock(host_.mutex);
    host_.scenes.publish(*shown);
}

void FogDesk::show(const Job& job, const Found& found) {
    std::optional<Failure> failure;
    try {
        if (found.fog) put(job, found);
    } catch (const RequestError& e) {
        failure = Failure{e.code, e.what(), e.where};
    }
    const std::lock_guard lock(host_.mutex);
    host_.scenes.breakPromise(job.asked.front().client);  // where it was of no use
    for (const auto& [asked, refusal] : found.refused) fail(asked, refusal);
    for (const Asked& asked : found.made) {
        if (failure)
            fail(asked, *failure);
        else
            host_.reply(asked.client, asked.id, LightChanged{});
    }
}

/// What does not work is refused by itself; the others go on.
FogDesk::Found FogDesk::find(const Job& job) const {
    const Check check = [&job] {
        if (job.cancelled.load()) throw GivenUp{};
    };
    Found found;
    found.keys = job.keys;
    std::vector<scene::FogMedium> media;
    for (const Asked& asked : job.asked) {
        try {
            check();
            requireMedia(asked.edits, job.media);
            MediaKeys keys = changedKeys(found.keys, asked.edits);
            media = mediaWith(*job.load, config_, keys, job.lit);
            found.keys = std::move(keys);
            found.made.push_back(asked);
        } catch (const RequestError& e) {
            found.refused.emplace_back(asked, Failure{e.code, e.what(), e.where});
        } catch (const InputError& e) {
            found.refused.emplace_back(asked, failureOf(e, asked.edits));
        }
    }
    if (found.made.empty()) return found;
    try {
        const auto start = Clock::now();
        found.fog = job.maker(media, check);
        found.milliseconds = millisecondsSince(start);
    } catch (const InputError& e) {
        for (const Asked& asked : std::exchange(found.made, {}))
            found.refused.emplace_back(asked, failureOf(e, asked.edits));
    }
    return found;
}

void FogDesk::loop() {
    setpriority(PRIO_PROCESS, 0, lowPriority);  // on Linux that of this thread
    tbb::task_arena alone(1);                   // the other threads are the frames'
    std::unique_lock lock(host_.mutex);
    while (true) {
        wake_.wait(lock, [this] { return stopping_ || (begun_ && !found_); });
        if (stopping_) return;
        const std::shared_ptr<Job> job = begun_;
        lock.unlock();
        Found found;
        try {
            alone.execute([&] { found = find(*job); });
        } catch (const GivenUp&) {
        } catch (const std::exception& e) {
            found = {};
            for (const Asked& asked : job->asked) found.refused.emplace_back(asked, Failure{"internal", e.what(), {}});
        }
        lock.lock();
        if (begun_ != job) continue;  // nobody waits for it any more
        found_ = std::move(found);
        lock.unlock();
        host_.wake();
        lock.lock();
    }
}

}  // namespace lumulus::service
