#include "service/net/token_guard.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>

namespace lumulus::service {
namespace {

/// Origins beyond these share one allowance.
constexpr std::size_t mostOrigins = 4096;

}  // namespace

std::string originOf(const std::string& from) {
    const std::string address = from.substr(0, from.rfind(':'));
    if (!address.starts_with('[')) return address;
    in6_addr parsed{};
    if (::inet_pton(AF_INET6, address.substr(1, address.size() - 2).c_str(), &parsed) != 1) return address;
    std::fill(std::begin(parsed.s6_addr) + 8, std::end(parsed.s6_addr), std::uint8_t{0});
    std::array<char, INET6_ADDRSTRLEN> text{};
    return ::inet_ntop(AF_INET6, &parsed, text.data(), text.size());
}

void TokenGuard::refill(Allowance& allowance, Clock::time_point now) const {
    const double seconds = std::chrono::duration<double>(now - allowance.at).count();
    allowance = {std::min(most_, allowance.guesses + seconds * rate_), now};
}

/// Forgets the origins that may guess as often as strangers.
void TokenGuard::forget(Clock::time_point now) {
    std::erase_if(known_, [&](const auto& entry) {
        Allowance allowance = entry.second;
        refill(allowance, now);
        return allowance.guesses >= most_;
    });
}

Clock::duration TokenGuard::take(const std::string& origin, Clock::time_point now) {
    if (known_.size() >= mostOrigins) forget(now);
    const bool many = known_.size() >= mostOrigins && !known_.contains(origin);
    Allowance& allowance = known_.try_emplace(many ? std::string() : origin, Allowance{most_, now}).first->second;
    refill(allowance, now);
    if (allowance.guesses >= 1.0) {
        allowance.guesses -= 1.0;
        return Clock::duration::zero();
    }
    const std::chrono::duration<double> wait((1.0 - allowance.guesses) / rate_);
    return std::chrono::ceil<std::chrono::milliseconds>(wait);
}

void TokenGuard::giveBack(const std::string& origin) {
    if (const auto it = known_.find(origin); it != known_.end())
        it->second.guesses = std::min(most_, it->second.guesses + 1.0);
}

}  // namespace lumulus::service
