#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "service/protocol/requests.h"

namespace lumulus::service {

using ClientId = std::uint64_t;
using Clock = std::chrono::steady_clock;

/// One picture to be made.
struct Job {
    ClientId client = 0;
    std::uint64_t id = 0;
    std::shared_ptr<const std::variant<FrameRequest, Composite>> work;
    Clock::time_point arrived;  ///< of a stream: when it was due
    bool stream = false;
    std::uint64_t number = 0;  ///< of the frame in its stream
    bool begun = false;        ///< its light is applied
    std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
};

template <class Work>
std::shared_ptr<const std::variant<FrameRequest, Composite>> workOf(Work work) {
    return std::make_shared<const std::variant<FrameRequest, Composite>>(std::move(work));
}

/// Which picture comes next. Clients take turns; in a channel the newest request takes the place of the one before;
/// a client that does not read gets nothing more. Holds a bounded number of requests. Not for several threads.
class Scheduler {
  public:
    struct Bounds {
        std::uint32_t queued = 8, streams = 16, unsent = 2;
    };
    /// Changes whenever a picture of the client's scene would.
    using Revision = std::function<std::uint64_t(ClientId)>;

    explicit Scheduler(Bounds bounds) : bounds_(bounds) {}

    void addClient(ClientId client);
    /// Forgets the client and cancels what it has under way.
    void removeClient(ClientId client);
    /// While a client waits for its scene nothing of it is taken.
    void setWaiting(ClientId client, bool waiting);

    /// Returns the ids of the requests that this one replaces. Errors: RequestError `busy`.
    std::vector<std::uint64_t> submit(Job job);
    /// Starts a stream, or gives the one with this id new wishes. Errors: RequestError `busy`.
    void startStream(ClientId client, std::uint64_t id, StartStream request, Clock::time_point now);
    /// Whether there was such a stream, or such a frame; the one under way is told by its flag.
    bool stopStream(ClientId client, std::uint64_t id);
    bool cancel(ClientId client, std::uint64_t id);

    /// The next picture, if any is due. A client whose turn it was goes to the end of the line.
    std::optional<Job> take(Clock::time_point now, const Revision& revision);
    /// Gives back what take() gave, to go on with it when its client's turn comes. False where it was superseded, or is
    /// no longer what its client waits for.
    bool putBack(const Job& job);
    /// The picture that take() gave is made or failed. False where nobody waits for it any more: its client is gone,
    /// its stream was stopped, or takeCurrent() has answered it.
    bool done(const Job& job);
    /// A frame of a stream that take() gave is not made: its stream gets another, even if nothing changes.
    void leaveOut(const Job& job);
    /// When the next stream is due that take() would give then; none where only changes bring one.
    std::optional<Clock::time_point> nextDue(const Revision& revision) const;

    void frameHandedOver(ClientId client);
    void frameSent(ClientId client);

    std::size_t streams() const;
    bool hasQueued() const;
    /// Ends all streams; a job with the id of each.
    std::vector<Job> endStreams();
    /// All that waits; it is forgotten.
    std::vector<Job> takeQueued();
    /// What is under way, told to stop: whoever makes it is not asked for it any more.
    std::vector<Job> takeCurrent();

  private:
    struct Stream {
        StartStream request;
        Clock::time_point due;
        std::optional<std::uint64_t> seen;  // revision of the last frame; none after new wishes
        std::uint64_t frames = 0;
    };
    struct Client {
        std::deque<Job> queue;
        std::map<std::uint64_t, Stream> streams;
        std::optional<Job> current;
        std::uint32_t unsent = 0;
        bool waiting = false;
    };

    bool blocked(const Client& client) const { return client.waiting || client.unsent >= bounds_.unsent; }
    static bool isCurrent(const Client& client, const Job& job) {
        return client.current && client.current->cancelled == job.cancelled;  // which every job has for itself
    }
    static bool wanted(const Stream& stream, std::uint64_t revision) {
        return !stream.request.onChange || stream.seen != revision;
    }
    static void forget(Client& client, std::uint64_t stream);
    std::optional<Job> takeFrom(ClientId id, Client& client, Clock::time_point now, const Revision& revision);

    Bounds bounds_;
    std::map<ClientId, Client> clients_;
    std::list<ClientId> line_;
};

}  // namespace lumulus::service
