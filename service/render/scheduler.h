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

#include "service/render/pace.h"
#include "service/telemetry/memory_budget.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// One frame or composite that a client waits for.
struct Job {
    ClientId client = 0;
    std::uint64_t id = 0;
    std::shared_ptr<const std::variant<FrameRequest, Composite>> work;
    std::shared_ptr<MemoryBudget::Share> memory = {};  ///< that the request holds
    Clock::time_point arrived;                         ///< of a stream: when it was due
    bool stream = false;
    std::uint64_t number = 0;  ///< of the frame in its stream, as Pace counts
    bool begun = false;        ///< whether its light is applied
    std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
};

template <class Work>
std::shared_ptr<const std::variant<FrameRequest, Composite>> workOf(Work work) {
    return std::make_shared<const std::variant<FrameRequest, Composite>>(std::move(work));
}

/// Decides which picture is drawn next. Clients share the time of the renderer: who has had the least of it comes
/// first, of equals whose last picture took less, and then who has waited longest (start-time fair queueing: Goyal, Vin
/// and Cheng 1996). In a channel the newest request replaces the one before; a client that does not read gets nothing
/// more. Holds a bounded number of requests. Not for several threads.
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

    /// The next picture, if any is due. Its client goes to the end of the line.
    std::optional<Job> take(Clock::time_point now, const Revision& revision);
    /// The same while another picture is drawn: of clients that are `allowed` and have none under way.
    std::optional<Job> takeBeside(Clock::time_point now, const Revision& revision,
                                  const std::function<bool(ClientId)>& allowed);
    /// Work for a client took so many milliseconds of the renderer.
    void charge(ClientId client, double milliseconds);
    /// Milliseconds that the last picture of a client took; 0 where it had none.
    double lastCost(ClientId client) const;
    /// Gives back what take() gave, to go on with it after those of the other clients. False where it was superseded,
    /// or is no longer what its client waits for.
    bool putBack(const Job& job);
    /// Ends the picture that take() gave, which failed. False where nobody waits for it any more: its client is gone,
    /// its stream was stopped, or takeCurrent() has answered it.
    bool done(const Job& job);
    /// The picture that take() gave is drawn and goes to be encoded; its client may get the next one meanwhile. It
    /// counts as unsent from now on. False, as done(), where nobody waits for it.
    bool drawn(const Job& job);
    /// The picture is encoded and goes to the client, or failed. False, as done(), where nobody waits for it; it is not
    /// unsent any more then.
    bool encoded(const Job& job);
    /// A frame of a stream that take() gave is not made: its stream gets another, even if nothing changes.
    void leaveOut(const Job& job);
    /// When the next stream is due that take() would give then; none where only changes bring one.
    std::optional<Clock::time_point> nextDue(Clock::time_point now, const Revision& revision) const;

    /// A client has taken a picture.
    void frameSent(ClientId client);

    std::size_t streams() const;
    bool hasQueued() const;
    /// Ends all streams; a job with the id of each.
    std::vector<Job> endStreams();
    /// All that waits; it is forgotten.
    std::vector<Job> takeQueued();
    /// Pictures that are drawn or encoded, told to stop: nobody waits for them any more.
    std::vector<Job> takeCurrent();

  private:
    struct Stream {
        StartStream request;
        Pace pace;
        std::optional<std::uint64_t> seen;  // revision of the last frame; none after new wishes
    };
    struct Client {
        std::deque<Job> queue;
        std::map<std::uint64_t, Stream> streams;
        std::optional<Job> current;  // is drawn
        std::vector<Job> encoding;   // are drawn
        std::uint32_t unsent = 0;
        bool waiting = false;
        double served = 0.0;  // milliseconds, as of `served_`: it does not save up what it did not ask for
        double lastCost = 0.0;
    };

    bool blocked(const Client& client) const { return client.waiting || client.unsent >= bounds_.unsent; }
    static bool same(const Job& a, const Job& b) { return a.cancelled == b.cancelled; }  // each has its own
    static bool isCurrent(const Client& client, const Job& job) { return client.current && same(*client.current, job); }
    template <class Condition>
    static void cancelUnderWay(Client& client, const Condition& condition);
    static bool wanted(const Stream& stream, std::uint64_t revision) {
        return !stream.request.onChange || stream.seen != revision;
    }
    static void forget(Client& client, std::uint64_t stream);
    template <class Condition>
    std::optional<Job> takeWhere(Clock::time_point now, const Revision& revision, const Condition& condition);
    std::optional<Job> takeFrom(ClientId id, Client& client, Clock::time_point now, const Revision& revision);

    Bounds bounds_;
    std::map<ClientId, Client> clients_;
    std::list<ClientId> line_;
    double served_ = 0.0;  // of the client whose picture was taken last, when it was
};

}  // namespace lumulus::service
