#include "service/net/hub.h"

#include <nlohmann/json.hpp>

#include "service/protocol/error_reply.h"
#include "service/protocol/replies.h"
#include "service/render/scene_list.h"
#include "service/telemetry/event_log.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

SessionPolicy policyOf(const Config& config) {
    const RenderLimits& limits = config.render.limits;
    const MessageLimits& messages = config.limits.messages;
    const Welcome welcome{config.render.defaultScene, config.render.quality, messages, limits.requests, limits.streams,
                          limits.queuedFrames};
    return {config.token, welcomeText(welcome), messages, limits.requests};
}

}  // namespace

Hub::Hub(const Config& config, Post post)
    : config_(config),
      policy_(policyOf(config)),
      post_(std::move(post)),
      uploads_(config.render.uploads, config.render.limits.uploadFolderBytes),
      bridge_(config.render, metrics_, [this](ClientId client, Message reply, bool frame) {
          // std::function wants what can be copied
          auto shared = std::make_shared<Message>(std::move(reply));
          post_([this, client, shared, frame] { deliver(client, std::move(*shared), frame); });
      }) {}

std::shared_ptr<Peer> Hub::open(const std::string& from, std::function<void()> wake) {
    if (full()) {
        metrics_.add(Metrics::connectionsRefused);
        return nullptr;
    }
    const ClientId client = nextClient_++;
    auto peer = std::make_shared<Peer>(client, from, policy_, config_.limits, std::move(wake));
    peers_[client] = peer;
    bridge_.service().addClient(client);
    metrics_.add(Metrics::connectionsOpened);
    metrics_.set(Metrics::connectionsOpen, static_cast<std::int64_t>(peers_.size()));
    logEvent("info", "connected", {{"client", client}, {"from", from}});
    return peer;
}

void Hub::close(const std::shared_ptr<Peer>& peer, const std::string& why) {
    if (peers_.erase(peer->client()) == 0) return;
    peer->closeNow();
    bridge_.service().removeClient(peer->client());
    uploads_.dropClient(peer->client());
    if (!peer->greeted()) metrics_.add(Metrics::tokensRefused);
    metrics_.set(Metrics::connectionsOpen, static_cast<std::int64_t>(peers_.size()));
    logEvent("info", "disconnected", {{"client", peer->client()}, {"name", peer->name()}, {"why", why}});
}

void Hub::received(Peer& peer, std::span<const std::byte> bytes) {
    metrics_.add(Metrics::bytesReceived, static_cast<std::int64_t>(bytes.size()));
    Session::Result result = peer.receive(bytes, Clock::now());
    metrics_.add(Metrics::requestsRefused, static_cast<std::int64_t>(result.refusals));
    for (Message& reply : result.replies) peer.enqueue(std::move(reply), false);
    for (Incoming& incoming : result.requests) dispatch(peer, std::move(incoming));
    if (result.close) peer.closeAfterWriting();
}

void Hub::dispatch(Peer& peer, Incoming incoming) {
    metrics_.add(Metrics::requestsTotal);
    const std::uint64_t id = incoming.id;
    // a stream's id comes again with new wishes
    const bool known = !peer.began(id);
    if (known && !std::holds_alternative<StartStream>(incoming.request)) {
        metrics_.add(Metrics::requestsRefused);
        peer.enqueue(errorReply(id, "bad_request", "a request with this id is under way"), false);
        return;
    }
    try {
        if (const auto* chunk = std::get_if<Upload>(&incoming.request)) {
            peer.enqueue(upload(peer, id, *chunk), false);
            peer.ended(id);
        } else if (std::holds_alternative<StatisticsRequest>(incoming.request)) {
            RenderService& service = bridge_.service();
            const std::optional<LoadState> loading = service.loadState(peer.client());
            peer.enqueue(statisticsReply(id, metrics_.values(), service.sceneState(peer.client()), loading), false);
            peer.ended(id);
        } else if (std::holds_alternative<ListScenes>(incoming.request)) {
            peer.enqueue(scenesReply(id, sceneNames(config_.render.scenes)), false);
            peer.ended(id);
        } else if (auto request = renderRequest(std::move(incoming.request))) {
            if (const auto* stop = std::get_if<StopStream>(&*request)) peer.ended(stop->stream);
            bridge_.service().submit(peer.client(), id, std::move(*request));
        }
    } catch (const RequestError& e) {
        if (!known) peer.ended(id);
        metrics_.add(Metrics::requestsRefused);
        peer.enqueue(errorReply(id, e.code, e.what(), e.where), false);
    }
}

Message Hub::upload(Peer& peer, std::uint64_t id, const Upload& chunk) {
    try {
        const UploadStore::Progress progress = uploads_.receive(peer.client(), chunk);
        if (progress.complete) metrics_.add(Metrics::uploadsCompleted);
        return uploadReply(id, progress.received, progress.complete);
    } catch (const RequestError& e) {
        metrics_.add(Metrics::uploadsFailed);
        logEvent("warning", "upload_failed", {{"client", peer.client()}, {"code", e.code}, {"message", e.what()}});
        throw;
    }
}

void Hub::deliver(ClientId client, Message reply, bool frame) {
    const auto it = peers_.find(client);
    if (it == peers_.end()) return;
    if (reply.type != replyTo(MessageType::startStream)) it->second->ended(reply.id);
    it->second->enqueue(std::move(reply), frame);
}

void Hub::sent(Peer& peer, std::size_t bytes, bool complete) {
    metrics_.add(Metrics::bytesSent, static_cast<std::int64_t>(bytes));
    const auto out = peer.wrote(complete, Clock::now());
    if (out && out->frame) bridge_.service().frameSent(peer.client());
}

void Hub::watch(Clock::time_point now) {
    std::vector<std::pair<std::shared_ptr<Peer>, std::string>> late;
    for (const auto& [client, peer] : peers_)
        if (auto why = peer->timedOut(now)) late.emplace_back(peer, std::move(*why));
    for (const auto& [peer, why] : late) {
        metrics_.add(Metrics::timeouts);
        close(peer, why);
    }
}

void Hub::closeAll() {
    for (const auto& [client, peer] : peers_) peer->closeAfterWriting();
}

}  // namespace lumulus::service
