#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "service/net/config.h"
#include "service/net/write_rate.h"
#include "service/protocol/session.h"
#include "service/telemetry/memory_budget.h"

namespace lumulus::service {

/// A message on its way out: header and JSON, payload.
struct Outgoing {
    std::vector<std::byte> head, payload;
    bool frame = false;
    MemoryBudget::Share memory;  ///< that it holds
};

/// One connection, whatever it runs over: its session, the messages that wait to be written, and how long it has been
/// slow. The transport reads and writes; nothing here blocks.
class Peer {
  public:
    /// `policy`, `limits` and `memory` must outlive this.
    Peer(ClientId client, std::string from, const SessionPolicy& policy, const ConnectionLimits& limits,
         MemoryBudget& memory, std::function<void()> wake);

    ClientId client() const { return client_; }
    /// Its address, for the log.
    const std::string& from() const { return from_; }

    /// Makes a few requests of bytes, which it takes off the front, and keeps the clocks of rates and timeouts. For the
    /// Hub.
    Session::Result receive(std::span<const std::byte>& bytes, Clock::time_point now);
    bool wrongToken() const { return session_.wrongToken(); }
    bool greeted() const { return session_.greeted(); }
    const std::string& name() const { return session_.client(); }

    /// Takes a message to be written, with the memory that it holds.
    void enqueue(Message message, bool frame, MemoryBudget::Share memory);
    /// The same where none is counted for it yet.
    void enqueue(Message message) { enqueue(std::move(message), false, {}); }
    /// The message to be written next; null where none waits.
    const Outgoing* next() const { return outbox_.empty() ? nullptr : &outbox_.front(); }
    /// Notes that bytes of next() have left. Where it is `complete`, it is removed and returned.
    std::optional<Outgoing> wrote(std::size_t bytes, bool complete);

    /// What waits once the connection has ended, to be freed where that takes no time from others: behind next(), whose
    /// bytes may be on their way, or with it.
    std::deque<Outgoing> takeRest();
    std::deque<Outgoing> takeAll() { return std::exchange(outbox_, {}); }

    /// Whether so much waits to be written or stored that no more input may be taken.
    bool overfull() const;
    /// Note the begin and the end of storing a piece of an upload.
    void storing() { ++storing_; }
    void stored();
    /// How long no more input may be taken, for a client that sends too many requests.
    Clock::duration pause(Clock::time_point now) const;

    /// End the connection when the waiting messages have been written, or at once.
    void closeAfterWriting();
    void closeNow();
    bool finished() const { return closed_ || (closing_ && outbox_.empty()); }
    bool closing() const { return closing_ || closed_; }
    bool closed() const { return closed_; }

    /// Why the connection has to end; none where it may go on.
    std::optional<std::string> timedOut(Clock::time_point now);

    /// Note the begin and the end of a request or a stream. While one is open, the connection is not idle. began()
    /// returns false where this id is open already.
    bool began(std::uint64_t id) { return open_.insert(id).second; }
    void ended(std::uint64_t id) { open_.erase(id); }

  private:
    ClientId client_;
    std::string from_;
    const ConnectionLimits& limits_;
    MemoryBudget& memory_;
    std::function<void()> wake_;
    Session session_;
    std::deque<Outgoing> outbox_;
    std::size_t outboxBytes_ = 0;
    std::size_t storing_ = 0;
    MemoryBudget::Share incoming_;  // of the message that is not complete
    WriteRate writing_;
    std::set<std::uint64_t> open_;
    bool closing_ = false, closed_ = false;
    double allowance_;  // requests that may come at once; fills up with time
    Clock::time_point connected_ = Clock::now(), lastMessage_ = connected_, allowanceAt_ = connected_;
    std::optional<Clock::time_point> messageBegan_;
};

}  // namespace lumulus::service
