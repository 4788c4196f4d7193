#pragma once

#include <map>
#include <string>

#include "service/values/requests.h"

namespace lumulus::service {

/// Where a connection comes from, without its port: an IPv4 address, the first 64 bits of an IPv6 address, or the user
/// of a Unix socket. `from` is as in the log: "127.0.0.1:40000", "[::1]:40000 websocket", "unix uid 1000".
std::string originOf(const std::string& from);

/// Slows down who guesses tokens: an origin may guess wrongly a few times at once, and then so often a second. On one
/// thread.
class TokenGuard {
  public:
    TokenGuard(double guessesPerSecond, double atOnce) : rate_(guessesPerSecond), most_(atOnce) {}

    /// Takes the right to give one token. Returns zero, or how long the origin has to wait before it asks again.
    Clock::duration take(const std::string& origin, Clock::time_point now);
    /// The token was right, or none was given.
    void giveBack(const std::string& origin);
    std::size_t size() const { return known_.size(); }

  private:
    struct Allowance {
        double guesses = 0.0;  ///< that are left
        Clock::time_point at;
    };
    void refill(Allowance& allowance, Clock::time_point now) const;
    void forget(Clock::time_point now);

    double rate_, most_;
    std::map<std::string, Allowance> known_;  // those that have given tokens lately
};

}  // namespace lumulus::service
