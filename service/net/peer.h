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
#include "service/render/scheduler.h"

namespace lumulus::service {

/// A message on its way out: header and JSON, payload.
struct Outgoing {
    std::vector<std::byte> head, payload;
    bool frame = false;
};

/// One connection, whatever it runs over: its session, what waits to be written, and how long it has been slow. The
/// transport reads and writes; nothing here blocks.
class Peer {
  public:
    Peer(ClientId client, std::string from, const SessionPolicy& policy, const Limits& limits,
         std::function<void()> wake);

    ClientId client() const { return client_; }
    /// Its address, for the log.
    const std::string& from() const { return from_; }

    /// For the Hub: bytes to requests, with the clock of rates and timeouts.
    Session::Result receive(std::span<const std::byte> bytes, Clock::time_point now);
    bool greeted() const { return session_.greeted(); }
    const std::string& name() const { return session_.client(); }

    void enqueue(Message message, bool frame);
    /// What is to be written next; null where nothing waits.
    const Outgoing* next() const { return outbox_.empty() ? nullptr : &outbox_.front(); }
    /// Tells that bytes of next() have left; `complete`: all of it, which is returned.
    std::optional<Outgoing> wrote(bool complete, Clock::time_point now);

    /// No more input is taken until something was written, or until a moment has passed.
    bool overfull() const;
    Clock::duration pause(Clock::time_point now) const;

    /// The connection ends when what waits has been written, or at once.
    void closeAfterWriting();
    void closeNow();
    bool finished() const { return closed_ || (closing_ && outbox_.empty()); }
    bool closing() const { return closing_ || closed_; }

    /// Why it has to end, if it has.
    std::optional<std::string> timedOut(Clock::time_point now) const;

    /// Requests that have not been answered, and streams; they keep the connection from being idle.
    /// False where this id is under way already.
    bool began(std::uint64_t id) { return open_.insert(id).second; }
    void ended(std::uint64_t id) { open_.erase(id); }

  private:
    ClientId client_;
    std::string from_;
    const Limits& limits_;
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
