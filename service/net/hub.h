#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "service/net/config.h"
#include "service/net/peer.h"
#include "service/net/render_bridge.h"
#include "service/net/token_guard.h"
#include "service/net/upload_desk.h"
#include "service/protocol/session.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

/// Knows all connections, and passes their requests to those who answer them. Lives on the one thread of the sockets.
class Hub {
  public:
    /// Runs a function later, on the thread of the sockets; called from any thread.
    using Post = std::function<void(std::function<void()>)>;

    /// `begun` is told, by `post`, that the default scene is there, or what is wrong with it. `config` and
    /// `instruments` must outlive this. Errors: InputError of the default scene's file and the folder of uploads.
    Hub(const Config& config, Instruments& instruments, Post post, std::function<void(std::exception_ptr)> begun);

    /// Opens a connection. `wake` is called when there is something to write, and when the connection has to end.
    std::shared_ptr<Peer> open(const std::string& from, std::function<void()> wake);
    void close(const std::shared_ptr<Peer>& peer, const std::string& why);
    /// Takes the right to give a token from an address. Returns zero, or how long to wait before it is asked for again.
    Clock::duration mayGuess(const std::string& from);
    /// Notes a token that came by HTTP.
    void guessed(const std::string& from, bool right);
    /// Takes bytes off the front of a peer's, and answers what they ask for.
    void received(Peer& peer, std::span<const std::byte>& bytes);
    /// Notes that bytes of the message which the peer was given first have left; `complete`: all of them.
    void sent(Peer& peer, std::size_t bytes, bool complete);
    /// Nothing more is written to it.
    void ended(Peer& peer);

    /// Ends connections that are slow or silent, and uploads that are old.
    void watch(Clock::time_point now);
    std::size_t connections() const { return peers_.size(); }

    /// Calls RenderService::shutDown. From another thread.
    void finishWork() { bridge_.service().shutDown(); }
    RenderService& service() { return bridge_.service(); }
    /// Ends every connection when the messages that wait for it have left.
    void closeAll();

    const Config& config() const { return config_; }
    Metrics& metrics() { return metrics_; }

  private:
    void dispatch(Peer& peer, Incoming incoming);
    void answer(Peer& peer, Incoming incoming);
    void deliver(ClientId client, RenderBridge::Outbound outbound);
    void stored(ClientId client, Message reply);
    void dispose(std::deque<Outgoing> messages);

    const Config& config_;
    Metrics& metrics_;
    EventLog& log_;
    MemoryBudget& memory_;
    SessionPolicy policy_;
    Post post_;
    TokenGuard guard_;
    std::map<ClientId, std::shared_ptr<Peer>> peers_;
    ClientId nextClient_ = 1;
    Clock::time_point expiry_;  // when uploads are looked at next
    UploadDesk uploads_;
    RenderBridge bridge_;  // last: its threads end first
};

}  // namespace lumulus::service
