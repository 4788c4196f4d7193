#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "service/net/config.h"
#include "service/net/peer.h"
#include "service/net/render_bridge.h"
#include "service/protocol/session.h"
#include "service/render/upload_store.h"
#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// Knows all connections, and passes their requests to those who answer them. Lives on the one thread of the sockets.
class Hub {
  public:
    /// Runs a function later, on the thread of the sockets; called from any thread.
    using Post = std::function<void(std::function<void()>)>;

    /// Errors: InputError and Error of the default scene and the folder of uploads.
    Hub(const Config& config, Post post);

    /// Opens a connection. Returns null where there are too many, or the service ends. `wake` is called when there is
    /// something to write, and when the connection has to end.
    std::shared_ptr<Peer> open(const std::string& from, std::function<void()> wake);
    void close(const std::shared_ptr<Peer>& peer, const std::string& why);
    /// Takes bytes from a peer and answers what they ask for.
    void received(Peer& peer, std::span<const std::byte> bytes);
    /// Notes that bytes of the message which the peer was given first have left; `complete`: all of them.
    void sent(Peer& peer, std::size_t bytes, bool complete);

    /// Ends connections that are slow or silent.
    void watch(Clock::time_point now);
    std::size_t connections() const { return peers_.size(); }
    /// Whether no connection can be opened. Those that speak HTTP count too.
    bool full() const { return closing_ || peers_.size() + *others_ >= config_.limits.connections; }
    /// The number of HTTP connections: each adds one as long as it lives, and may outlive the hub.
    std::shared_ptr<std::size_t> others() { return others_; }

    /// Calls RenderService::shutDown. From another thread.
    void finishWork() { bridge_.service().shutDown(); }
    void refuseNew() { closing_ = true; }
    /// Ends every connection when the messages that wait for it have left.
    void closeAll();

    const Config& config() const { return config_; }
    Metrics& metrics() { return metrics_; }

  private:
    void dispatch(Peer& peer, Incoming incoming);
    Message upload(Peer& peer, std::uint64_t id, const Upload& chunk);
    void deliver(ClientId client, Message reply, bool frame);

    const Config& config_;
    Metrics metrics_;
    SessionPolicy policy_;
    Post post_;
    UploadStore uploads_;
    std::map<ClientId, std::shared_ptr<Peer>> peers_;
    ClientId nextClient_ = 1;
    std::shared_ptr<std::size_t> others_ = std::make_shared<std::size_t>(0);
    bool closing_ = false;
    RenderBridge bridge_;  // last: its threads end first
};

}  // namespace lumulus::service
