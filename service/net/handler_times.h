#pragma once

#include <chrono>

// Asio calls these where it runs a handler (BOOST_ASIO_CUSTOM_HANDLER_TRACKING,
// boost/asio/detail/handler_tracking.hpp), so that no handler is forgotten. Asio includes this file inside of its own,
// before everything else of it.

namespace lumulus::service {

class Metrics;

/// Tells `metrics` how long the handlers take that the thread runs which made it, while it lives. `metrics` must
/// outlive it. One a thread at a time.
class HandlerTimes {
  public:
    explicit HandlerTimes(Metrics& metrics);
    HandlerTimes(const HandlerTimes&) = delete;
    HandlerTimes& operator=(const HandlerTimes&) = delete;
    ~HandlerTimes();

    /// On the thread of the sockets nothing may take longer.
    static constexpr std::chrono::milliseconds bound{10};

    void took(std::chrono::microseconds time);
    /// Time that the thread has waited for a core while others had all of them; 0 where the kernel does not tell.
    std::chrono::nanoseconds waitedForCore() const;

  private:
    Metrics& metrics_;
    int accounts_;  ///< the kernel's of the thread; -1 where there are none
    std::chrono::microseconds longest_{};
};

/// Lives while a handler runs.
class HandlerTimer {
  public:
    HandlerTimer();
    HandlerTimer(const HandlerTimer&) = delete;
    HandlerTimer& operator=(const HandlerTimer&) = delete;
    ~HandlerTimer();

  private:
    std::chrono::nanoseconds waitedBefore_;  // for a core; read first, or a wait between the two would count
    std::chrono::steady_clock::time_point begun_;
};

}  // namespace lumulus::service

#define BOOST_ASIO_INHERIT_TRACKED_HANDLER
#define BOOST_ASIO_ALSO_INHERIT_TRACKED_HANDLER
#define BOOST_ASIO_HANDLER_TRACKING_INIT static_cast<void>(0)
#define BOOST_ASIO_HANDLER_LOCATION(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_CREATION(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_COMPLETION(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_INVOCATION_BEGIN(args) const ::lumulus::service::HandlerTimer lumulusHandlerTimer
#define BOOST_ASIO_HANDLER_INVOCATION_END static_cast<void>(0)
#define BOOST_ASIO_HANDLER_OPERATION(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_REACTOR_REGISTRATION(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_REACTOR_DEREGISTRATION(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_REACTOR_READ_EVENT 0
#define BOOST_ASIO_HANDLER_REACTOR_WRITE_EVENT 0
#define BOOST_ASIO_HANDLER_REACTOR_ERROR_EVENT 0
#define BOOST_ASIO_HANDLER_REACTOR_EVENTS(args) static_cast<void>(0)
#define BOOST_ASIO_HANDLER_REACTOR_OPERATION(args) static_cast<void>(0)
