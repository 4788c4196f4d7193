#include "service/net/peer.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace lumulus::service {

namespace {

/// Replies that may wait besides frames: a client that does not read them is not heard.
constexpr std::size_t mostWaiting = 256;
constexpr std::size_t mostWaitingBytes = std::size_t{256} << 20U;
/// Pieces of uploads that may wait to be stored.
constexpr std::size_t mostStoring = 2;
/// Messages that are understood before others have the thread.
constexpr std::size_t mostAtOnce = 16;

double secondsBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Peer::Peer(ClientId client, std::string from, const SessionPolicy& policy, const ConnectionLimits& limits,
           MemoryBudget& memory, std::function<void()> wake)
    : client_(client),
      from_(std::move(from)),
      limits_(limits),
      memory_(memory),
      wake_(std::move(wake)),
      session_(policy),
      incoming_(memory.open(MemoryBudget::messages)),
      writing_(limits.writeSeconds, limits.writeBytesPerSecond),
      allowance_(limits.requestsPerSecond) {}

Session::Result Peer::receive(std::span<const std::byte>& bytes, Clock::time_point now) {
    Session::Result result = session_.receive(bytes, mostAtOnce);
    if (!incoming_.tryResize(session_.held())) {
        Session::Result refused =
            session_.refuse({"busy", "the service has no memory for so large a message now: try again later"});
        std::ranges::move(refused.replies, std::back_inserter(result.replies));
        result.refusals += refused.refusals;
        result.close = true;
        incoming_.resize(0);
        bytes = {};
    }
    const auto messages = static_cast<double>(result.requests.size() + result.replies.size());
    const double refilled = allowance_ + secondsBetween(allowanceAt_, now) * limits_.requestsPerSecond;
    allowance_ = std::min(refilled, limits_.requestsPerSecond) - messages;
    allowanceAt_ = now;
    if (messages > 0.0) lastMessage_ = now;
    if (!session_.midMessage())
        messageBegan_.reset();
    else if (!messageBegan_ || messages > 0.0)
        messageBegan_ = now;
    return result;
}

void Peer::enqueue(Message message, bool frame, MemoryBudget::Share memory) {
    if (closed_) return;
    Outgoing out;
    out.memory = std::move(memory);
    out.head = encodeHead(message);
    out.payload = std::move(message.payload);
    out.frame = frame;
    const std::size_t bytes = out.head.size() + out.payload.size();
    if (out.memory.bytes() == 0) out.memory = memory_.hold(MemoryBudget::messages, bytes);
    outboxBytes_ += bytes;
    writing_.begin(Clock::now());
    outbox_.push_back(std::move(out));
    wake_();
}

std::optional<Outgoing> Peer::wrote(std::size_t bytes, bool complete) {
    writing_.wrote(bytes);
    if (!complete) return std::nullopt;
    Outgoing out = std::move(outbox_.front());
    outbox_.pop_front();
    outboxBytes_ -= out.head.size() + out.payload.size();
    if (outbox_.empty()) writing_.end();
    return out;
}

std::deque<Outgoing> Peer::takeRest() {
    std::deque<Outgoing> rest = std::exchange(outbox_, {});
    if (rest.empty()) return rest;
    outbox_.push_back(std::move(rest.front()));  // its bytes may be on their way
    rest.pop_front();
    return rest;
}

bool Peer::overfull() const {
    return outbox_.size() >= mostWaiting || outboxBytes_ >= mostWaitingBytes || storing_ >= mostStoring;
}

void Peer::stored() {
    --storing_;
    wake_();
}

Clock::duration Peer::pause(Clock::time_point now) const {
    const double owed = -allowance_ - secondsBetween(allowanceAt_, now) * limits_.requestsPerSecond;
    if (owed <= 0.0) return Clock::duration::zero();
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(owed / limits_.requestsPerSecond));
}

void Peer::closeAfterWriting() {
    closing_ = true;
    wake_();
}

void Peer::closeNow() {
    closed_ = true;
    wake_();
}

std::optional<std::string> Peer::timedOut(Clock::time_point now) {
    if (!greeted() && secondsBetween(connected_, now) > limits_.helloSeconds) return "no hello";
    if (messageBegan_ && secondsBetween(*messageBegan_, now) > limits_.messageSeconds) return "a message took too long";
    if (writing_.tooSlow(now)) return "does not read";
    if (open_.empty() && outbox_.empty() && secondsBetween(lastMessage_, now) > limits_.idleSeconds) return "idle";
    return std::nullopt;
}

}  // namespace lumulus::service
