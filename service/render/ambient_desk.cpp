#include "service/render/ambient_desk.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::ptrdiff_t mostWaiting = 4;  // of one client
/// Of a point: the sun's irradiance and nine coefficients, R, G and B each.
constexpr int channels = 30;

/// Works out the next point. Errors: those of the scene; RequestError where it lies below the ground.
std::vector<float> nextPoint(SceneSlot& slot, const QueryJob& job, std::size_t done) {
    const std::vector<double>& n = job.request.numbers;
    std::vector<float> values;
    for (const glm::dvec3& value : slot.ambientAt({n[3 * done], n[3 * done + 1], n[3 * done + 2]}, job.cancelled.get()))
        for (int channel = 0; channel < 3; ++channel) values.push_back(static_cast<float>(value[channel]));
    return values;
}

/// What a client is told of an error; nothing where it has gone or has cancelled the query.
std::optional<Failure> failureOf(const std::exception_ptr& error, std::size_t row) {
    try {
        std::rethrow_exception(error);
    } catch (const Cancelled&) {
        return std::nullopt;
    } catch (const TooSlow& e) {
        return Failure{"too_large", e.what(), {}};
    } catch (const InputError& e) {
        return Failure{"bad_request", e.what(), "row " + std::to_string(row)};
    } catch (const std::exception& e) {
        return Failure{"internal", e.what(), {}};
    }
}

}  // namespace

void AmbientDesk::submit(QueryJob job) {
    const auto waiting = std::ranges::count_if(
        asked_, [&job](const std::shared_ptr<Asked>& one) { return one->job.client == job.client; });
    if (waiting >= mostWaiting) throw RequestError("busy", "four queries wait already");
    asked_.push_back(std::make_shared<Asked>(Asked{std::move(job), {}}));
}

bool AmbientDesk::presses(Clock::time_point now) const {
    constexpr auto longest = std::chrono::milliseconds(200);
    return any() && now - lastStep_ > longest;
}

bool AmbientDesk::cancel(ClientId client, std::uint64_t id) {
    return std::erase_if(asked_, [&](const std::shared_ptr<Asked>& one) {
               if (one->job.client != client || one->job.id != id) return false;
               one->job.cancelled->store(true);
               return true;
           }) > 0;
}

void AmbientDesk::removeClient(ClientId client) {
    std::erase_if(asked_, [client](const std::shared_ptr<Asked>& one) {
        if (one->job.client != client) return false;
        one->job.cancelled->store(true);
        return true;
    });
}

std::vector<QueryJob> AmbientDesk::takeAll() {
    std::vector<QueryJob> jobs;
    for (const std::shared_ptr<Asked>& one : std::exchange(asked_, {})) {
        one->job.cancelled->store(true);
        jobs.push_back(one->job);
    }
    return jobs;
}

void AmbientDesk::step() {
    std::shared_ptr<Asked> asked;
    SlotPointer slot;
    {
        const std::lock_guard lock(mutex_);
        lastStep_ = Clock::now();
        if (asked_.empty()) return;
        asked = asked_.front();
        slot = scenes_.shownTo(asked->job.client);
    }
    const std::size_t done = asked->values.size() / channels, all = asked->job.request.numbers.size() / 3;
    std::optional<Failure> failure;
    std::vector<float> point;
    if (!slot) {
        failure = Failure{"no_scene", "the scene is gone: load one", {}};
    } else {
        try {
            point = nextPoint(*slot, asked->job, done);
        } catch (...) {
            failure = failureOf(std::current_exception(), done);
        }
    }
    const std::lock_guard lock(mutex_);
    lastStep_ = Clock::now();
    if (asked->job.cancelled->load() || asked_.empty()) return;  // somebody else has answered
    asked_.pop_front();
    asked->values.insert(asked->values.end(), point.begin(), point.end());
    if (failure)
        answer_(asked->job.client, asked->job.id, *failure);
    else if (done + 1 < all)
        asked_.push_back(asked);
    else
        answer_(asked->job.client, asked->job.id,
                QueryAnswer{QueryProduct::ambient, static_cast<int>(all), 1, channels, std::move(asked->values)});
}

}  // namespace lumulus::service
