#include "service/net/hub.h"

#include <nlohmann/json.hpp>

#include "service/protocol/error_reply.h"
#include "service/protocol/replies.h"
#include "service/render/scene_list.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

/// Wrong tokens that an address may give at once.
constexpr double guessesAtOnce = 10.0;
/// Payloads from this size on are freed on another thread.
constexpr std::size_t largeBytes = std::size_t{4} << 20U;

SessionPolicy policyOf(const Config& config) {
    const RenderLimits& limits = config.render.limits;
    const MessageLimits& messages = config.limits.messages;
    const Welcome welcome{
        config.render.defaultScene, config.render.quality,    messages, limits.requests, limits.streams,
        limits.queuedFrames,        config.render.sharedLight};
    return {config.token, welcomeText(welcome), messages, limits.requests};
}

}  // namespace

Hub::Hub(const Config& config, Instruments& instruments, Post post, std::function<void(std::exception_ptr)> begun)
    : config_(config),
      metrics_(instruments.metrics),
      log_(instruments.log),
      memory_(instruments.memory),
      policy_(policyOf(config)),
      post_(std::move(post)),
      guard_(config.limits.guessesPerSecond, guessesAtOnce),
      uploads_(config.render, instruments,
               [this](ClientId client, Message reply) {
                   auto shared = std::make_shared<Message>(std::move(reply));  // std::function wants what can be copied
                   post_([this, client, shared] { stored(client, std::move(*shared)); });
               }),
      bridge_(
          config.render, instruments,
          [this](ClientId client, RenderBridge::Outbound outbound) {
              auto shared = std::make_shared<RenderBridge::Outbound>(std::move(outbound));
              post_([this, client, shared] { deliver(client, std::move(*shared)); });
          },
          [this, begun = std::move(begun)](const std::exception_ptr& error) {
              post_([begun, error] { begun(error); });
          }) {}

std::shared_ptr<Peer> Hub::open(const std::string& from, std::function<void()> wake) {
    const ClientId client = nextClient_++;
    auto peer = std::make_shared<Peer>(client, from, policy_, config_.limits, memory_, std::move(wake));
    peers_[client] = peer;
    bridge_.service().addClient(client);
    metrics_.add(Metrics::connectionsOpened);
    metrics_.set(Metrics::connectionsOpen, static_cast<std::int64_t>(peers_.size()));
    log_.event("info", "connected", {{"client", client}, {"from", from}});
    return peer;
}

void Hub::close(const std::shared_ptr<Peer>& peer, const std::string& why) {
    if (peers_.erase(peer->client()) == 0) return;
    peer->closeNow();
    dispose(peer->takeRest());
    bridge_.service().removeClient(peer->client());
    uploads_.dropConnection(peer->client());
    metrics_.set(Metrics::connectionsOpen, static_cast<std::int64_t>(peers_.size()));
    log_.event("info", "disconnected", {{"client", peer->client()}, {"name", peer->name()}, {"why", why}});
}

Clock::duration Hub::mayGuess(const std::string& from) {
    return config_.token.empty() ? Clock::duration::zero() : guard_.take(originOf(from), Clock::now());
}

void Hub::guessed(const std::string& from, bool right) {
    if (right) {
        guard_.giveBack(originOf(from));
        return;
    }
    metrics_.add(Metrics::tokensRefused);
    log_.event("warning", "token_refused", {{"from", from}});
}

void Hub::received(Peer& peer, std::span<const std::byte>& bytes) {
    const std::size_t before = bytes.size();
    const bool known = peer.greeted();
    Session::Result result = peer.receive(bytes, Clock::now());
    metrics_.add(Metrics::bytesReceived, static_cast<std::int64_t>(before - bytes.size()));
    metrics_.add(Metrics::requestsRefused, static_cast<std::int64_t>(result.refusals));
    if (!known && (peer.greeted() || result.close)) guessed(peer.from(), !peer.wrongToken());
    for (Message& reply : result.replies) peer.enqueue(std::move(reply));
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
        peer.enqueue(errorReply(id, "bad_request", "a request with this id is under way"));
        return;
    }
    try {
        answer(peer, std::move(incoming));
    } catch (const RequestError& e) {
        if (!known) peer.ended(id);
        metrics_.add(Metrics::requestsRefused);
        peer.enqueue(errorReply(id, e.code, e.what(), e.where));
    }
}

void Hub::answer(Peer& peer, Incoming incoming) {
    const std::uint64_t id = incoming.id;
    const std::string owner = originOf(peer.from());
    Request& request = incoming.request;
    const auto memoryFor = [&](MemoryBudget::Use use) { return memory_.hold(use, incoming.payloadBytes); };
    if (auto* piece = std::get_if<Upload>(&request)) {
        peer.storing();
        uploads_.receive(peer.client(), owner, id, std::move(*piece), memoryFor(MemoryBudget::uploads));
    } else if (std::holds_alternative<ListUploads>(request)) {
        peer.storing();
        uploads_.list(peer.client(), owner, id);
    } else if (const auto* file = std::get_if<DeleteUpload>(&request)) {
        peer.storing();
        uploads_.remove(peer.client(), owner, id, file->hash);
    } else if (std::holds_alternative<StatisticsRequest>(request)) {
        RenderService& service = bridge_.service();
        const std::optional<LoadState> loading = service.loadState(peer.client());
        peer.enqueue(statisticsReply(id, metrics_.values(), service.sceneState(peer.client()), loading));
        peer.ended(id);
    } else if (std::holds_alternative<ListScenes>(request)) {
        peer.storing();
        uploads_.answer(peer.client(), [this, id] { return scenesReply(id, sceneNames(config_.render.scenes)); });
    } else if (auto wanted = renderRequest(std::move(request))) {
        if (const auto* stop = std::get_if<StopStream>(&*wanted)) peer.ended(stop->stream);
        bridge_.service().submit(peer.client(), id, std::move(*wanted), memoryFor(MemoryBudget::messages));
    }
}

void Hub::stored(ClientId client, Message reply) {
    const auto it = peers_.find(client);
    if (it == peers_.end()) return;
    it->second->ended(reply.id);
    it->second->enqueue(std::move(reply));
    it->second->stored();
}

void Hub::deliver(ClientId client, RenderBridge::Outbound outbound) {
    const auto it = peers_.find(client);
    if (it == peers_.end() || it->second->closed()) {
        bridge_.dispose(std::make_shared<RenderBridge::Outbound>(std::move(outbound)));
        return;
    }
    if (outbound.message.type != replyTo(MessageType::startStream)) it->second->ended(outbound.message.id);
    it->second->enqueue(std::move(outbound.message), outbound.frame, std::move(outbound.memory));
}

void Hub::sent(Peer& peer, std::size_t bytes, bool complete) {
    metrics_.add(Metrics::bytesSent, static_cast<std::int64_t>(bytes));
    auto out = peer.wrote(bytes, complete);
    if (out && out->frame) bridge_.service().frameSent(peer.client());
    if (out && out->payload.size() > largeBytes) bridge_.dispose(std::make_shared<Outgoing>(std::move(*out)));
}

void Hub::ended(Peer& peer) {
    dispose(peer.takeAll());
}

void Hub::dispose(std::deque<Outgoing> messages) {
    if (!messages.empty()) bridge_.dispose(std::make_shared<std::deque<Outgoing>>(std::move(messages)));
}

void Hub::watch(Clock::time_point now) {
    std::vector<std::pair<std::shared_ptr<Peer>, std::string>> late;
    for (const auto& [client, peer] : peers_)
        if (auto why = peer->timedOut(now)) late.emplace_back(peer, std::move(*why));
    for (const auto& [peer, why] : late) {
        metrics_.add(Metrics::timeouts);
        close(peer, why);
    }
    if (now < expiry_) return;
    uploads_.expire();
    expiry_ = now + std::chrono::minutes(1);
}

void Hub::closeAll() {
    for (const auto& [client, peer] : peers_) peer->closeAfterWriting();
}

}  // namespace lumulus::service
