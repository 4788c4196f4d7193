#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "service/net/config.h"
#include "service/protocol/session.h"

namespace lumulus::service {

/// A message on its way out: header and JSON, payload.
struct Outgoing {
    std::vector<std::byte> head, payload;
    bool frame = false;
};

/// One connection, whatever it runs over: its session, the messages that wait to be written, and how long it has been
/// slow. The transport reads and writes; nothing here blocks.
class Peer {
  public:
    Peer(ClientId client, std::string from, const SessionPolicy& policy, const ConnectionLimits& limits,
         std::function<void()> wake);

    ClientId client() const { return client_; }
    /// Its address, for the log.
    const std::string& from() const { return from_; }

    /// Makes requests of bytes, and keeps the clocks of rates and timeouts. For the Hub.
    Session::Result receive(std::span<const std::byte> bytes, Clock::time_point now);
    bool greeted() const { return session_.greeted(); }
    const std::string& name() const { return session_.client(); }

    void enqueue(Message message, bool frame);
    /// The message to be written next; null where none waits.
    const Outgoing* next() const { return outbox_.empty() ? nullptr : &outbox_.front(); }
    /// Notes that bytes of next() have left. Where it is `complete`, it is removed and returned.
    std::optional<Outgoing> wrote(bool complete, Clock::time_point now);

    /// Whether so much waits to be written that no more input may be taken.
    bool overfull() const;
    /// How long no more input may be taken, for a client that sends too many requests.
    Clock::duration pause(Clock::time_point now) const;

    /// End the connection when the waiting messages have been written, or at once.
    void closeAfterWriting();
    void closeNow();
    bool finished() const { return closed_ || (closing_ && outbox_.empty()); }
    bool closing() const { return closing_ || closed_; }

    /// Why the connection has to end; none where it may go on.
    std::optional<std::string> timedOut(Clock::time_point now) const;

    /// Note the begin and the end of a request or a stream. While one is open, the connection is not idle. began()
    /// returns false where this id is open already.
    bool began(std::uint64_t id) { return open_.insert(id).second; }
    void ended(std::uint64_t id) { open_.erase(id); }

  private:
    ClientId client_;
    std::string from_;
    const ConnectionLimits& limits_;
    std::function<void()> wake_;
    Session session_;
    std::deque<Outgoing> outbox_;
    std::size_t outboxBytes_ = 0;
    std::set<std::uint64_t> open_;
    bool closing_ = false, closed_ = false;
    double allowance_;  // requests that may come at once; fills up with time
    Clock::time_point connected_ = Clock::now(), lastMessage_ = connected_, allowanceAt_ = connected_;
    std::optional<Clock::time_point> messageBegan_, waitingSince_;
};

}  // namespace lumulus::service
