#include "service/render/scheduler.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

/// Milliseconds that a client may have had more than the others, before what is more is forgotten.
constexpr double mostOwed = 1000.0;
/// What a picture may take more than the last one of its client: a factor, and milliseconds.
constexpr double mostGrowth = 4.0, always = 20.0;

std::optional<std::uint32_t> channelOf(const Job& job) {
    const auto* frame = std::get_if<FrameRequest>(job.work.get());
    if (frame == nullptr || frame->queue) return std::nullopt;
    return frame->channel;
}

}  // namespace

/// Tells those who draw or encode pictures of the client to stop, where `condition(job)` holds.
template <class Condition>
void Scheduler::cancelUnderWay(Client& client, const Condition& condition) {
    if (client.current && condition(*client.current)) client.current->cancelled->store(true);
    for (const Job& job : client.encoding)
        if (condition(job)) job.cancelled->store(true);
}

void Scheduler::addClient(ClientId client) {
    if (clients_.try_emplace(client).second) line_.push_back(client);
}

void Scheduler::removeClient(ClientId client) {
    const auto it = clients_.find(client);
    if (it == clients_.end()) return;
    cancelUnderWay(it->second, [](const Job&) { return true; });
    clients_.erase(it);
    line_.remove(client);
}

void Scheduler::setWaiting(ClientId client, bool waiting) {
    if (const auto it = clients_.find(client); it != clients_.end()) it->second.waiting = waiting;
}

std::vector<std::uint64_t> Scheduler::submit(Job job) {
    Client& client = clients_.at(job.client);
    std::vector<std::uint64_t> replaced;
    if (const auto channel = channelOf(job)) {
        std::erase_if(client.queue, [&](const Job& waiting) {
            if (channelOf(waiting) != channel) return false;
            if (waiting.stream)
                forget(client, waiting.id);
            else
                replaced.push_back(waiting.id);
            return true;
        });
    }
    if (client.queue.size() >= bounds_.queued)
        throw RequestError("busy", std::to_string(bounds_.queued) + " frames wait already: take some first");
    client.queue.push_back(std::move(job));
    return replaced;
}

void Scheduler::startStream(ClientId id, std::uint64_t stream, StartStream request, Clock::time_point now) {
    Client& client = clients_.at(id);
    const auto it = client.streams.find(stream);
    if (it != client.streams.end()) {
        it->second.pace.wish(request, now);
        it->second.request = std::move(request);
        it->second.seen.reset();
        return;
    }
    if (client.streams.size() >= bounds_.streams)
        throw RequestError("busy", std::to_string(bounds_.streams) + " streams run already: stop some first");
    const Pace pace(request, now);
    client.streams.emplace(stream, Stream{std::move(request), pace, std::nullopt});
}

bool Scheduler::stopStream(ClientId id, std::uint64_t stream) {
    const auto it = clients_.find(id);
    if (it == clients_.end()) return false;
    Client& client = it->second;
    cancelUnderWay(client, [&](const Job& job) { return job.stream && job.id == stream; });
    std::erase_if(client.queue, [&](const Job& job) { return job.stream && job.id == stream; });
    return client.streams.erase(stream) > 0;
}

bool Scheduler::cancel(ClientId id, std::uint64_t request) {
    const auto it = clients_.find(id);
    if (it == clients_.end()) return false;
    Client& client = it->second;
    if (std::erase_if(client.queue, [&](const Job& job) { return !job.stream && job.id == request; }) > 0) return true;
    cancelUnderWay(client, [&](const Job& job) { return !job.stream && job.id == request; });
    return false;
}

std::optional<Job> Scheduler::takeFrom(ClientId id, Client& client, Clock::time_point now, const Revision& revision) {
    if (!client.queue.empty()) {
        Job job = std::move(client.queue.front());
        client.queue.pop_front();
        return job;
    }
    if (client.streams.empty()) return std::nullopt;
    const std::uint64_t current = revision(id);
    auto best = client.streams.end();
    for (auto it = client.streams.begin(); it != client.streams.end(); ++it) {
        if (!wanted(it->second, current) || it->second.pace.next(now) > now) continue;
        if (best == client.streams.end() || it->second.pace.due() < best->second.pace.due()) best = it;
    }
    if (best == client.streams.end()) return std::nullopt;
    Stream& stream = best->second;
    const Pace::Frame frame = stream.pace.take(now);
    stream.seen = current;
    return Job{id, best->first, workOf(stream.request.frame), {}, frame.since, true, frame.number};
}

std::optional<Job> Scheduler::take(Clock::time_point now, const Revision& revision) {
    return takeWhere(now, revision, [](ClientId, const Client&) { return true; });
}

std::optional<Job> Scheduler::takeBeside(Clock::time_point now, const Revision& revision,
                                         const std::function<bool(ClientId)>& allowed) {
    return takeWhere(now, revision, [&](ClientId id, const Client& client) { return !client.current && allowed(id); });
}

template <class Condition>
std::optional<Job> Scheduler::takeWhere(Clock::time_point now, const Revision& revision, const Condition& condition) {
    std::vector<std::list<ClientId>::iterator> order;
    for (auto it = line_.begin(); it != line_.end(); ++it) {
        Client& client = clients_.at(*it);
        if (blocked(client) || !condition(*it, client)) continue;
        client.served = std::clamp(client.served, served_, served_ + mostOwed);
        order.push_back(it);
    }
    std::ranges::stable_sort(order, {}, [this](const auto& it) {
        const Client& client = clients_.at(*it);
        return std::pair(client.served, client.lastCost);
    });
    for (const auto& it : order) {
        Client& client = clients_.at(*it);
        if (auto job = takeFrom(*it, client, now, revision)) {
            served_ = client.served;
            client.current = *job;
            line_.splice(line_.end(), line_, it);
            return job;
        }
    }
    return std::nullopt;
}

void Scheduler::charge(ClientId id, double milliseconds) {
    const auto it = clients_.find(id);
    if (it == clients_.end()) return;
    // a picture during which the machine stood still is none of its client's doing
    const double last = it->second.lastCost;
    const double believed = last > 0.0 ? std::min(milliseconds, mostGrowth * last + always) : milliseconds;
    it->second.served += believed;
    it->second.lastCost = believed;
}

double Scheduler::lastCost(ClientId client) const {
    const auto it = clients_.find(client);
    return it == clients_.end() ? 0.0 : it->second.lastCost;
}

bool Scheduler::putBack(const Job& job) {
    const auto it = clients_.find(job.client);
    if (it == clients_.end() || !isCurrent(it->second, job)) return false;
    const auto channel = channelOf(job);
    const bool superseded =
        channel && std::ranges::any_of(it->second.queue, [&](const Job& newer) { return channelOf(newer) == channel; });
    if (superseded) return false;
    it->second.current.reset();
    it->second.queue.push_front(job);
    return true;
}

bool Scheduler::done(const Job& job) {
    const auto it = clients_.find(job.client);
    if (it == clients_.end() || !isCurrent(it->second, job)) return false;
    it->second.current.reset();
    return !(job.stream && job.cancelled->load());
}

bool Scheduler::drawn(const Job& job) {
    if (!done(job)) return false;
    Client& client = clients_.at(job.client);
    client.encoding.push_back(job);
    ++client.unsent;
    return true;
}

bool Scheduler::encoded(const Job& job) {
    const auto it = clients_.find(job.client);
    if (it == clients_.end()) return false;
    const bool waited = std::erase_if(it->second.encoding, [&](const Job& one) { return same(one, job); }) > 0;
    const bool wanted = waited && !(job.stream && job.cancelled->load());
    if (!wanted) frameSent(job.client);
    return wanted;
}

void Scheduler::leaveOut(const Job& job) {
    const auto it = clients_.find(job.client);
    if (it == clients_.end()) return;
    if (isCurrent(it->second, job)) it->second.current.reset();
    forget(it->second, job.id);
}

/// Forgets what the stream has shown.
void Scheduler::forget(Client& client, std::uint64_t stream) {
    if (const auto it = client.streams.find(stream); it != client.streams.end()) it->second.seen.reset();
}

std::optional<Clock::time_point> Scheduler::nextDue(Clock::time_point now, const Revision& revision) const {
    std::optional<Clock::time_point> next;
    for (const auto& [id, client] : clients_) {
        if (blocked(client) || client.streams.empty()) continue;
        const std::uint64_t current = revision(id);
        for (const auto& [number, stream] : client.streams)
            if (wanted(stream, current) && (!next || stream.pace.next(now) < *next)) next = stream.pace.next(now);
    }
    return next;
}

void Scheduler::frameSent(ClientId client) {
    if (const auto it = clients_.find(client); it != clients_.end() && it->second.unsent > 0) --it->second.unsent;
}

std::size_t Scheduler::streams() const {
    std::size_t count = 0;
    for (const auto& [id, client] : clients_) count += client.streams.size();
    return count;
}

bool Scheduler::hasQueued() const {
    return std::ranges::any_of(clients_, [](const auto& entry) { return !entry.second.queue.empty(); });
}

std::vector<Job> Scheduler::endStreams() {
    std::vector<Job> all;
    for (auto& [id, client] : clients_) {
        for (const auto& [number, stream] : client.streams) {
            Job job;
            job.client = id;
            job.id = number;
            job.stream = true;
            all.push_back(std::move(job));
        }
        std::erase_if(client.queue, [](const Job& job) { return job.stream; });
        client.streams.clear();
    }
    return all;
}

std::vector<Job> Scheduler::takeQueued() {
    std::vector<Job> all;
    for (auto& [id, client] : clients_) std::ranges::move(std::exchange(client.queue, {}), std::back_inserter(all));
    return all;
}

std::vector<Job> Scheduler::takeCurrent() {
    std::vector<Job> all;
    for (auto& [id, client] : clients_) {
        cancelUnderWay(client, [](const Job&) { return true; });
        if (client.current) all.push_back(*std::exchange(client.current, std::nullopt));
        std::ranges::move(std::exchange(client.encoding, {}), std::back_inserter(all));
    }
    return all;
}

}  // namespace lumulus::service
