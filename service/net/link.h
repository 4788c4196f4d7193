#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "service/net/asio.h"
#include "service/net/hub.h"

namespace lumulus::service {

/// One connection of the protocol over whatever carries bytes: a coroutine that reads and one that writes, which end
/// together. A Carrier has
/// - `executor()`;
/// - `awaitable<std::span<const std::byte>> read(error_code&)`: what came, valid until the next call;
/// - `awaitable<std::size_t> write(head, payload, done, error_code&)`: writes some of both together, beginning at byte
///   `done`, and returns how many bytes;
/// - `trust()`: who sends has said hello, and may send more at once;
/// - `close()`: ends what waits for either.
template <class Carrier>
class Link : public std::enable_shared_from_this<Link<Carrier>> {
  public:
    Link(Carrier carrier, Hub& hub)
        : carrier_(std::move(carrier)), hub_(hub), wake_(carrier_.executor()), pause_(carrier_.executor()) {
        wake_.expires_at(asio::steady_timer::time_point::max());
    }

    /// Serves until the connection ends. `from` is its address, for the log; `seat` is taken meanwhile.
    asio::awaitable<void> run(std::string from, [[maybe_unused]] std::shared_ptr<void> seat) {
        const std::weak_ptr<Link> weak = this->weak_from_this();
        peer_ = hub_.open(from, [weak] {
            if (const auto self = weak.lock()) self->notify();
        });
        asio::co_spawn(
            carrier_.executor(), [self = this->shared_from_this()] { return self->write(); }, asio::detached);
        co_await read();
    }

  private:
    /// Whoever waits looks again: the writer for something to write, the reader for room.
    void notify() {
        if (peer_ && peer_->finished()) {
            carrier_.close();
            pause_.cancel();
        }
        wake_.cancel();
    }

    asio::awaitable<void> sleep() {
        error_code woken;
        co_await wake_.async_wait(intoError(woken));
    }

    asio::awaitable<void> pauseFor(Clock::duration time) {
        error_code ignored;
        pause_.expires_after(time);
        co_await pause_.async_wait(intoError(ignored));
    }

    /// Waits until the address may give a token.
    asio::awaitable<void> admit() {
        while (!peer_->closing()) {
            const auto wait = hub_.mayGuess(peer_->from());
            if (wait == Clock::duration::zero()) co_return;
            co_await pauseFor(wait);
        }
    }

    /// Answers what came, a few messages at a time, as the client reads the answers.
    asio::awaitable<void> answer(std::span<const std::byte> bytes) {
        while (!bytes.empty() && !peer_->closing()) {
            hub_.received(*peer_, bytes);
            while (peer_->overfull() && !peer_->closing()) co_await sleep();
            if (const auto wait = peer_->pause(Clock::now()); wait > Clock::duration::zero()) co_await pauseFor(wait);
            // other connections have the thread between the messages of this one
            if (!bytes.empty()) co_await asio::post(carrier_.executor(), asio::use_awaitable);
        }
    }

    asio::awaitable<void> read() {
        error_code error;
        bool admitted = false;
        while (!peer_->closing()) {
            const std::span<const std::byte> bytes = co_await carrier_.read(error);
            if (error) break;
            if (!admitted) co_await admit();
            admitted = true;
            co_await answer(bytes);
            if (peer_->greeted()) carrier_.trust();
        }
        // what a client is told last, it should be able to read
        while (!error && !peer_->finished()) co_await sleep();
        hub_.close(peer_, error ? error.message() : "closed");
    }

    asio::awaitable<void> write() {
        error_code error;
        while (!error && !peer_->finished()) {
            const Outgoing* out = peer_->next();
            if (out == nullptr) {
                co_await sleep();
                continue;
            }
            const std::size_t total = out->head.size() + out->payload.size();
            for (std::size_t done = 0; done < total && !error;) {
                const std::size_t count = co_await carrier_.write(out->head, out->payload, done, error);
                done += count;
                if (!error) hub_.sent(*peer_, count, done == total);
            }
            wake_.cancel();  // the reader may wait for room
        }
        peer_->closeNow();
        hub_.ended(*peer_);
        notify();
    }

    Carrier carrier_;
    Hub& hub_;
    asio::steady_timer wake_, pause_;
    std::shared_ptr<Peer> peer_;
};

/// Accepts until the acceptor is closed; `take` gets each socket.
template <class Acceptor, class Take>
asio::awaitable<void> acceptAll(std::shared_ptr<Acceptor> acceptor, Take take) {
    constexpr auto pauseAfterFailure = std::chrono::milliseconds(100);  // as for want of descriptors
    asio::steady_timer pause(acceptor->get_executor());
    while (acceptor->is_open()) {
        error_code error;
        auto socket = co_await acceptor->async_accept(intoError(error));
        if (error == asio::error::operation_aborted) co_return;
        if (!error) {
            take(std::move(socket));
            continue;
        }
        pause.expires_after(pauseAfterFailure);
        co_await pause.async_wait(intoError(error));
    }
}

}  // namespace lumulus::service
