#include "service/render/query_desk.h"

#include <sys/resource.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::ptrdiff_t mostWaiting = 4;  // of one client
constexpr int lowPriority = 10;            // niceness: frames go first

/// Thrown where nobody waits any more.
struct GivenUp {};

QueryAnswer passagesOf(QueryProduct product, const std::vector<query::Passage>& passages) {
    QueryAnswer answer{product, static_cast<int>(passages.size()), 1, 6, {}};
    answer.values.reserve(passages.size() * 6);
    for (const query::Passage& passage : passages) {
        const glm::vec3 share(passage.transmittance()), depth(passage.opticalDepth);
        answer.values.insert(answer.values.end(), {share.r, share.g, share.b, depth.r, depth.g, depth.b});
    }
    return answer;
}

QueryAnswer shadowOf(const LayeredImage& image) {
    QueryAnswer answer{QueryProduct::groundShadow, image.width, image.height, 3, {}};
    answer.values.reserve(image.pixels() * 3);
    for (std::size_t i = 0; i < image.pixels(); ++i)
        for (const char* name : {"R", "G", "B"}) answer.values.push_back(image.layers.at(name)[i]);
    return answer;
}

QueryAnswer answerTo(const QueryRequest& request, const query::Media& media, const glm::dvec3& directionTo,
                     const Check& check) {
    const std::vector<double>& n = request.numbers;
    if (request.product == QueryProduct::segments) {
        std::vector<query::Segment> segments;
        for (std::size_t i = 0; i < n.size(); i += 6)
            segments.push_back({{n[i], n[i + 1], n[i + 2]}, {n[i + 3], n[i + 4], n[i + 5]}});
        return passagesOf(request.product, query::alongSegments(media, segments, check));
    }
    if (request.product == QueryProduct::sun) {
        std::vector<glm::dvec3> points;
        for (std::size_t i = 0; i < n.size(); i += 3) points.emplace_back(n[i], n[i + 1], n[i + 2]);
        return passagesOf(request.product, query::towardsSun(media, points, directionTo, check));
    }
    const std::vector<double>& r = request.rectangle;  // a ground shadow: ambient light is the AmbientDesk's
    const double y = request.y.value_or(media.ground.value_or(0.0));
    return shadowOf(
        query::groundShadow(media, {r[0], r[1], r[2], r[3], y, request.width, request.height}, directionTo, check));
}

}  // namespace

QueryDesk::QueryDesk(std::mutex& mutex, const Answer& answer)
    : mutex_(mutex), answer_(answer), thread_([this] { loop(); }) {}

void QueryDesk::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        if (current_) current_->cancelled->store(true);
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void QueryDesk::submit(QueryJob job) {
    const auto ofClient = [&job](const QueryJob& other) { return other.client == job.client; };
    const auto waiting = std::ranges::count_if(asked_, ofClient) +
                         std::ranges::count_if(ready_, [&](const Ready& ready) { return ofClient(ready.job); });
    if (waiting >= mostWaiting) throw RequestError("busy", "four queries wait already");
    asked_.push_back(std::move(job));
}

void QueryDesk::hand(QueryJob job, query::Media media, const glm::dvec3& directionTo) {
    if (job.cancelled->load()) return;
    ready_.push_back({std::move(job), std::move(media), directionTo});
    wake_.notify_all();
}

template <class Condition>
std::vector<QueryJob> QueryDesk::takeWhere(const Condition& condition) {
    std::vector<QueryJob> taken;
    std::erase_if(asked_, [&](QueryJob& job) {
        if (!condition(job)) return false;
        taken.push_back(std::move(job));
        return true;
    });
    std::erase_if(ready_, [&](Ready& ready) {
        if (!condition(ready.job)) return false;
        taken.push_back(std::move(ready.job));
        return true;
    });
    if (current_ && condition(*current_)) taken.push_back(*std::exchange(current_, std::nullopt));
    for (const QueryJob& job : taken) job.cancelled->store(true);
    return taken;
}

bool QueryDesk::cancel(ClientId client, std::uint64_t id) {
    return !takeWhere([&](const QueryJob& job) { return job.client == client && job.id == id; }).empty();
}

void QueryDesk::removeClient(ClientId client) {
    takeWhere([client](const QueryJob& job) { return job.client == client; });
}

std::vector<QueryJob> QueryDesk::takeAll() {
    return takeWhere([](const QueryJob&) { return true; });
}

void QueryDesk::loop() {
    setpriority(PRIO_PROCESS, 0, lowPriority);  // on Linux that of this thread
    tbb::task_arena alone(1);                   // the other threads are the frames'
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stopping_ || !ready_.empty(); });
        if (stopping_) return;
        const Ready ready = std::move(ready_.front());
        ready_.pop_front();
        current_ = ready.job;
        lock.unlock();
        Reply reply;
        try {
            const Check check = [&ready] {
                if (ready.job.cancelled->load()) throw GivenUp{};
            };
            alone.execute([&] { reply = answerTo(ready.job.request, ready.media, ready.directionTo, check); });
        } catch (const GivenUp&) {
        } catch (const std::exception& e) {
            reply = Failure{"internal", e.what(), {}};
        }
        lock.lock();
        if (!ready.job.cancelled->load()) answer_(ready.job.client, ready.job.id, std::move(reply));
        current_.reset();
    }
}

}  // namespace lumulus::service
