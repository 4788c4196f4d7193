#include "service/net/upload_desk.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "service/protocol/error_reply.h"
#include "service/protocol/replies.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

constexpr std::uint64_t lane = 0;  // one after the other, whoever asks
constexpr double secondsPerHour = 3600.0;

UploadStore::Limits limitsOf(const RenderLimits& limits) {
    return {limits.uploadFolderBytes, limits.uploadClientBytes, limits.uploadHours * secondsPerHour};
}

}  // namespace

UploadDesk::UploadDesk(const RenderConfig& config, Instruments& instruments, Reply reply)
    : instruments_(instruments),
      reply_(std::move(reply)),
      ownerBytes_(config.limits.uploadClientBytes),
      store_(config.uploads, limitsOf(config.limits)) {}

void UploadDesk::receive(ClientId connection, const std::string& owner, std::uint64_t id, Upload piece,
                         MemoryBudget::Share memory) {
    // std::function wants what can be copied
    const auto held = std::make_shared<std::pair<Upload, MemoryBudget::Share>>(std::move(piece), std::move(memory));
    thread_.submit(lane, [this, connection, owner, id, held] {
        Message reply = received(connection, owner, id, held->first);
        *held = {};
        reply_(connection, std::move(reply));
    });
}

Message UploadDesk::received(ClientId connection, const std::string& owner, std::uint64_t id, const Upload& piece) {
    try {
        const UploadStore::Progress progress = store_.receive(connection, owner, piece);
        if (progress.complete) instruments_.metrics.add(Metrics::uploadsCompleted);
        return uploadReply(id, progress.received, progress.complete);
    } catch (const RequestError& e) {
        instruments_.metrics.add(Metrics::uploadsFailed);
        instruments_.metrics.add(Metrics::requestsRefused);
        instruments_.log.event("warning", "upload_failed",
                               {{"client", connection}, {"code", e.code}, {"message", e.what()}});
        return errorReply(id, e.code, e.what(), e.where);
    } catch (const std::exception& e) {
        instruments_.log.event("error", "upload_failed", {{"client", connection}, {"message", e.what()}});
        return errorReply(id, "storage", "the upload cannot be stored");
    }
}

void UploadDesk::list(ClientId connection, const std::string& owner, std::uint64_t id) {
    thread_.submit(
        lane, [this, connection, owner, id] { reply_(connection, uploadsReply(id, store_.list(owner), ownerBytes_)); });
}

void UploadDesk::remove(ClientId connection, const std::string& owner, std::uint64_t id, const std::string& hash) {
    thread_.submit(lane, [this, connection, owner, id, hash] {
        reply_(connection, uploadDeletedReply(id, store_.remove(owner, hash)));
    });
}

void UploadDesk::answer(ClientId connection, std::function<Message()> make) {
    thread_.submit(lane, [this, connection, make = std::move(make)] { reply_(connection, make()); });
}

void UploadDesk::dropConnection(ClientId connection) {
    thread_.submit(lane, [this, connection] { store_.dropConnection(connection); });
}

void UploadDesk::expire() {
    thread_.submit(lane, [this] {
        const std::size_t files = store_.expire(UploadStore::FileClock::now());
        if (files > 0) instruments_.log.event("info", "uploads_expired", {{"files", files}});
    });
}

}  // namespace lumulus::service
