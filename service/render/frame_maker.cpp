#include "service/render/frame_maker.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "service/render/durations.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

const Failure shuttingDown{"shutting_down", "the service is shutting down", {}};
constexpr const char* noMemory = "there is no memory for so many pixels now: ask for fewer, or later";

}  // namespace

/// Puts a slot among those at which work is under way, while it lives.
class FrameMaker::Busy {
  public:
    Busy(FrameMaker& maker, const SceneSlot& slot) : maker_(maker) {
        const auto now = Clock::now();
        maker_.busy_.push_back({&slot, now, now, maker_.others_});
    }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    ~Busy() { maker_.busy_.pop_back(); }

  private:
    FrameMaker& maker_;
};

double FrameMaker::workedSince(Clock::time_point begun, Clock::duration othersBefore) const {
    return milliseconds(Clock::now() - begun - (others_ - othersBefore));
}

FrameMaker::FrameMaker(Instruments& instruments, Host host)
    : metrics_(instruments.metrics), log_(instruments.log), memory_(instruments.memory), host_(std::move(host)) {}

void FrameMaker::publish(const SceneSlot& slot) {
    const std::lock_guard lock(host_.mutex);
    host_.scenes.publish(slot);
}

void FrameMaker::applyChanges() {
    std::vector<PendingChanges::Change> changes;
    std::vector<EncodingDesk::Cost> costs;
    {
        const std::lock_guard lock(host_.mutex);
        changes = host_.changes.takeAll();
        costs = host_.encoding.takeCosts();
    }
    apply(changes);
    host_.densities.work();
    host_.fogs.work();
    for (const EncodingDesk::Cost& cost : costs)
        if (const SlotPointer slot = cost.slot.lock())
            slot->noteEncoded(cost.encoding, cost.report.milliseconds, cost.report.pixels);
}

void FrameMaker::apply(const std::vector<PendingChanges::Change>& changes) {
    for (const PendingChanges::Change& change : changes) {
        std::optional<Failure> failure;
        try {
            makeChange(change);
        } catch (const RequestError& e) {
            log_.event("warning", "change_refused", {{"scene", change.slot->scene().source}, {"message", e.what()}});
            failure = Failure{e.code, e.what(), e.where};
        }
        const std::lock_guard lock(host_.mutex);
        if (change.density && !host_.changes.wants(change)) continue;  // answered by others
        host_.changes.made(change);
        if (!change.edits.empty() || change.density)
            host_.scenes.breakPromise(change.client);  // where it was of no use
        if (change.request)
            host_.reply(change.client, *change.request, failure ? Reply(*failure) : Reply(LightChanged{}));
        else if (failure)
            host_.lights.noteFailure(change.client, *failure);
    }
}

/// Lets a loader prepare another density. Errors: RequestError.
void FrameMaker::prepare(const PendingChanges::Change& change, const SlotPointer& shown) {
    const std::optional<CloudReference> cloud = change.named ? std::optional(change.reference) : std::nullopt;
    const auto wish =
        std::make_shared<const DensityWish>(DensityWish{{shown->scene(), shown->key(), shown->load()},
                                                        *change.density,
                                                        cloudsOfDensity(shown->scene(), *change.density, cloud)});
    const std::lock_guard lock(host_.mutex);
    if (!host_.changes.wants(change)) return;
    if (host_.closing) throw RequestError(shuttingDown.code, shuttingDown.text);
    host_.scenesToCome.prepare({change.client, *change.request, {}, {}, wish});
    host_.changes.made(change);
}

/// Errors: RequestError.
void FrameMaker::makeChange(const PendingChanges::Change& change) {
    if (!change.request) return changeLight(change.client, change.slot, change.light, change.cloud);
    SlotPointer shown;
    {
        const std::lock_guard lock(host_.mutex);
        shown = host_.scenes.shownTo(change.client);
    }
    if (!shown) throw RequestError("no_scene", "the scene is gone: load one");
    if (change.density) return prepare(change, shown);
    if (change.edits.empty()) {  // of clouds that have changed just before
        std::optional<std::size_t> cloud;
        if (change.named) cloud = findCloud(shown->scene(), change.reference);
        return changeLight(change.client, shown, change.light, cloud);
    }
    const EditedClouds edited = editClouds(shown->sceneNow(), change.edits);
    if (edited.rebuilds) shown = host_.lights.edit(change.client, shown, edited);
    const scene::Scene now = shown->sceneNow();
    for (std::size_t i = 0; i < edited.origins.size(); ++i) {
        LightChange light;
        if (now.clouds[i].extinction != edited.scene.clouds[i].extinction)
            light.extinction = edited.scene.clouds[i].extinction;
        light.move = edited.moves[i];
        if (!light.empty()) changeLight(change.client, shown, light, i);
    }
    publish(*shown);
}

/// Errors: RequestError.
void FrameMaker::changeLight(ClientId client, const SlotPointer& slot, const LightChange& light,
                             std::optional<std::size_t> cloud) {
    const SlotPointer changed = host_.lights.toChange(client, slot, light, cloud);
    changed->apply(light, cloud);
    publish(*changed);
}

/// Errors: those of the scene.
void FrameMaker::trace(const SlotPointer& slot, bool generation) {
    const Busy busy(*this, *slot);
    if (generation) {
        slot->traceGeneration();
        metrics_.add(Metrics::generationsTraced);
    } else {
        slot->sharpenSun();
    }
    publish(*slot);
}

void FrameMaker::refine(const SlotPointer& slot, bool generation) {
    try {
        trace(slot, generation);
    } catch (const TooSlow& e) {
        {
            const std::lock_guard lock(host_.mutex);
            for (const ClientId client : host_.scenes.clientsOf(slot))
                host_.lights.noteFailure(client, {"too_large", e.what(), {}});
        }
        if (!bringBack(slot, "generation_cut_off", e)) dropSlot(slot, "generation_failed", e.what());
    } catch (const std::exception& e) {
        dropSlot(slot, "generation_failed", e.what());
    }
}

/// Where a scene takes longer than the limits allow since its light changed, brings the light of before back. Light of
/// a client's own without one goes. Returns false where there is neither.
bool FrameMaker::bringBack(const SlotPointer& slot, const char* event, const TooSlow& error) {
    const bool reverted = slot->revert();
    if (!reverted && !slot->source()) return false;
    log_.event("warning", event, {{"scene", slot->scene().source}, {"message", error.what()}});
    const std::lock_guard lock(host_.mutex);
    // the first light of its own has nothing traced under the light of before: the scene as it was loaded has; other
    // clouds go with their light
    const PhotonState photons = slot->state().photons;
    if (slot->source() && photons.current == 0 && (photons.generations == 0 || !reverted))
        host_.scenes.drop(slot);
    else
        host_.scenes.publish(*slot);
    return true;
}

/// Errors: RequestError where the budget does not have it.
MemoryBudget::Share FrameMaker::roomFor(std::uint64_t bytes) {
    auto share = memory_.take(MemoryBudget::frames, bytes);
    if (!share) throw RequestError("busy", noMemory);
    return std::move(*share);
}

void FrameMaker::make(const Job& job) {
    SlotPointer slot;
    bool closing = false;
    std::optional<Failure> failure;
    {
        const std::lock_guard lock(host_.mutex);
        slot = host_.scenes.shownTo(job.client);
        closing = host_.closing;
        failure = host_.lights.takeFailure(job.client);
    }
    if (failure) return fail(job, *failure);
    const auto begin = Clock::now();
    const Clock::duration othersBefore = others_;
    makeFor(job, slot, closing);
    const std::lock_guard lock(host_.mutex);
    host_.scheduler.charge(job.client, workedSince(begin, othersBefore));
}

/// The same for a client who sees `slot`.
void FrameMaker::makeFor(const Job& job, SlotPointer slot, bool closing) {
    try {
        if (job.cancelled->load()) throw Cancelled{};
        if (!slot && closing) throw RequestError(shuttingDown.code, shuttingDown.text);
        if (!slot) throw RequestError("no_scene", "load a scene first");
        if (const auto* composite = std::get_if<Composite>(job.work.get())) {
            MemoryBudget::Share memory = roomFor(SceneSlot::pictureBytes(composite->pixels.size() / 16));
            const Busy busy(*this, *slot);
            handOver(job, slot->composite(job, *composite), slot, std::move(memory));
        } else {
            const auto& frame = std::get<FrameRequest>(*job.work);
            if (!job.begun) slot = host_.lights.toChange(job.client, slot, frame.light, std::nullopt);
            makeFrame(job, frame, slot);
        }
    } catch (const RequestError& e) {
        fail(job, {e.code, e.what(), e.where});
    } catch (const Cancelled&) {
        fail(job, {"cancelled", "cancelled on request", {}});
    } catch (const TooSlow& e) {
        if (!bringBack(slot, "frame_cut_off", e) && !e.ofPicture()) dropSlot(slot, "frame_failed", e.what());
        fail(job, {"too_large", e.what(), {}});
    } catch (const std::exception& e) {
        fail(job, {"internal", e.what(), {}});
        dropSlot(slot, "frame_failed", e.what());
    }
}

void FrameMaker::makeFrame(Job job, const FrameRequest& frame, SlotPointer slot) {
    if (!job.begun && !frame.light.empty() && !slot->canChange()) return waitFor(job, slot);
    // once: of two lights that clients ask for alternately, neither would ever see all its generations
    if (!job.begun) slot->apply(frame.light);
    job.begun = true;
    bool hurry = false;
    {
        const std::lock_guard lock(host_.mutex);
        hurry = host_.closing;
    }
    // between the steps of other work, which is to go on soon
    const bool mayTrace = slot->canTrace() && (busy_.empty() || slot->tracesQuickly());
    if (!hurry && slot->needsGeneration(job, frame)) {
        if (!mayTrace) return waitFor(job, slot);
        trace(slot, true);
        return putBack(job, slot);
    }
    // a stream without a budget refines as it goes
    const bool refines = job.stream && !frame.budget.milliseconds && !frame.budget.photons && slot->wantsGeneration();
    if (refines && !hurry && mayTrace) trace(slot, true);
    auto memory = memory_.take(MemoryBudget::frames, slot->frameBytes(frame));
    if (!memory && job.stream) return leaveOut(job);
    if (!memory) throw RequestError("busy", noMemory);
    const Busy busy(*this, *slot);
    FrameResult drawn = slot->draw(job, frame);
    publish(*slot);
    handOver(job, std::move(drawn), slot, std::move(*memory));
}

/// Seconds until a picture is due, within what a step of a generation may take.
double FrameMaker::untilDue() {
    const std::lock_guard lock(host_.mutex);
    const auto now = Clock::now();
    const auto due = host_.scheduler.nextDue(now, [this](ClientId client) { return host_.scenes.revision(client); });
    constexpr double share = 0.8;  // steps do not take quite what they should
    const double left = due ? share * std::chrono::duration<double>(*due - now).count() : WorkGuard::longStep;
    return std::clamp(left, WorkGuard::shortStep, WorkGuard::longStep);
}

/// Makes the changes of light that can be made between two steps.
void FrameMaker::applyBetween() {
    std::vector<PendingChanges::Change> changes;
    {
        const std::lock_guard lock(host_.mutex);
        changes = host_.changes.takeWhere([&](const PendingChanges::Change& change) {
            const SlotPointer shown = host_.scenes.shownTo(change.client);
            return change.slot->canChange() && !(shown && !shown->canChange());
        });
    }
    apply(changes);
    host_.densities.work();
    host_.fogs.work();
}

/// Makes the next picture that is foreseen to take at most so many milliseconds. Returns whether there was one.
bool FrameMaker::makeOther(double limit) {
    std::optional<Job> job;
    {
        const std::lock_guard lock(host_.mutex);
        if (host_.closing || host_.encoding.full()) return false;
        const auto allowed = [&](ClientId client) {
            const SlotPointer shown = host_.scenes.shownTo(client);
            return shown && shown->canDraw() && !host_.changes.anyOf(client) &&
                   host_.scheduler.lastCost(client) <= limit && std::ranges::find(waiting_, client) == waiting_.end();
        };
        const auto revision = [this](ClientId client) { return host_.scenes.revision(client); };
        job = host_.scheduler.takeBeside(Clock::now(), revision, allowed);
    }
    if (!job) return false;
    make(std::move(*job));
    return true;
}

double FrameMaker::interject(const SceneSlot& slot) {
    constexpr std::size_t deepest = 4;
    constexpr double leastWorked = 20.0;  // milliseconds of a picture before another comes within
    if (busy_.empty() || busy_.back().slot != &slot || busy_.size() >= deepest) return WorkGuard::longStep;
    const auto begin = Clock::now();
    const Clock::duration othersBefore = others_;
    const std::size_t place = busy_.size() - 1;
    const Clock::duration step = begin - busy_[place].lastStep;
    const double worked = workedSince(busy_[place].begun, busy_[place].othersBefore);
    const bool drawing = !slot.canChange();
    if (!drawing || worked >= leastWorked) {
        applyBetween();
        waiting_.clear();
        const double limit = drawing ? worked : std::numeric_limits<double>::max();
        while (makeOther(limit) && Clock::now() - begin < step) {
        }
    }
    busy_[place].lastStep = Clock::now();
    others_ = othersBefore + (busy_[place].lastStep - begin);
    return untilDue();
}

/// Puts back what cannot go on before work around it does.
void FrameMaker::waitFor(const Job& job, const SlotPointer& slot) {
    waiting_.push_back(job.client);
    putBack(job, slot);
}

void FrameMaker::putBack(const Job& job, const SlotPointer& slot) {
    bool kept = false;
    {
        const std::lock_guard lock(host_.mutex);
        const SlotPointer shown = host_.scenes.shownTo(job.client);
        kept = shown && shown->isOfSameScene(*slot) && host_.scheduler.putBack(job);
    }
    if (!kept) leaveOut(job);
}

void FrameMaker::leaveOut(const Job& job) {
    if (!job.stream) {
        fail(job, {"superseded", "a newer frame of the channel takes its place, or its scene is gone", {}});
        return;
    }
    const std::lock_guard lock(host_.mutex);
    host_.scheduler.leaveOut(job);
}

void FrameMaker::handOver(const Job& job, std::variant<FrameResult, CompositeResult> result, const SlotPointer& slot,
                          MemoryBudget::Share memory) {
    {
        const std::lock_guard lock(host_.mutex);
        if (!host_.scheduler.drawn(job)) return;
        host_.encoding.begin();
    }
    host_.encode({job, std::move(result), slot, std::move(memory)});
}

void FrameMaker::fail(const Job& job, const Failure& failure) {
    {
        const std::lock_guard lock(host_.mutex);
        if (!host_.scheduler.done(job)) return;
        if (job.stream) host_.scheduler.stopStream(job.client, job.id);
        host_.reply(job.client, job.id, failure);
    }
    metrics_.add(Metrics::requestsRefused);
}

/// A renderer in which something failed is of no more use; its clients have to load again. The default scene is loaded
/// again for them.
void FrameMaker::dropSlot(const SlotPointer& slot, const char* event, const std::string& why) {
    if (!slot || interrupted()) return;  // the service ends
    log_.event("error", event, {{"scene", slot->scene().source}, {"message", why}});
    const std::lock_guard lock(host_.mutex);
    const bool wasDefault = host_.scenes.isDefault(slot);
    host_.scenes.drop(slot);
    if (wasDefault && !host_.closing) host_.scenesToCome.loadDefaultAgain();
    metrics_.set(Metrics::scenesHeld, static_cast<std::int64_t>(host_.scenes.size()));
}

}  // namespace lumulus::service
