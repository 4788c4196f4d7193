#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "service/net/config.h"
#include "service/net/peer.h"
#include "service/protocol/session.h"
#include "service/render/render_service.h"
#include "service/render/upload_store.h"
#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// What all connections share, on the one thread of the sockets: who is there, and who answers which request.
class Hub {
  public:
    /// Runs a function later, on the thread of the sockets; called from any thread.
    using Post = std::function<void(std::function<void()>)>;

    /// Errors: InputError and Error of the default scene and the folder of uploads.
    Hub(const Config& config, Post post);

    /// A new connection; null where there are too many, or the service ends. `wake` is called when there is something
    /// to write or the connection is to end.
    std::shared_ptr<Peer> open(const std::string& from, std::function<void()> wake);
    void close(const std::shared_ptr<Peer>& peer, const std::string& why);
    /// Takes bytes from a peer and answers what they ask for.
    void received(Peer& peer, std::span<const std::byte> bytes);
    /// What the peer was given first has left.
    void sent(Peer& peer, std::size_t bytes, bool complete);

    /// Ends connections that are slow or silent.
    void watch(Clock::time_point now);
    std::size_t connections() const { return peers_.size(); }
    /// Connections that speak HTTP count too.
    bool full() const { return closing_ || peers_.size() + *others_ >= config_.limits.connections; }
    /// For connections that may outlive this: each adds one as long as it lives.
    std::shared_ptr<std::size_t> others() { return others_; }

    /// From another thread: see RenderService::shutDown.
    void finishWork() { service_.shutDown(); }
    void refuseNew() { closing_ = true; }
    /// Every connection ends when it has been sent what waits for it.
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
    RenderService service_;  // last: its threads end first
};

}  // namespace lumulus::service
