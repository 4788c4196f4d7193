#pragma once

#include <functional>
#include <string>

#include "service/net/encoder_pool.h"
#include "service/protocol/message.h"
#include "service/protocol/requests.h"
#include "service/render/render_config.h"
#include "service/render/upload_store.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {

/// Answers all that concerns uploads, on a thread of its own, one after the other: writing and hashing take their time.
class UploadDesk {
  public:
    /// Takes the answer to a request of a connection. Called on the thread of the uploads.
    using Reply = std::function<void(ClientId, Message)>;

    /// `instruments` must outlive this. Errors: InputError where the folder cannot be made.
    UploadDesk(const RenderConfig& config, Instruments& instruments, Reply reply);

    /// Takes a piece, with the memory that it holds. `owner` is who the file will belong to.
    void receive(ClientId connection, const std::string& owner, std::uint64_t id, Upload piece,
                 MemoryBudget::Share memory);
    void list(ClientId connection, const std::string& owner, std::uint64_t id);
    void remove(ClientId connection, const std::string& owner, std::uint64_t id, const std::string& hash);
    /// Removes what a connection has not completed.
    /// Answers with what `make` returns, which reads files too.
    void answer(ClientId connection, std::function<Message()> make);
    void dropConnection(ClientId connection);
    void expire();

  private:
    Message received(ClientId connection, const std::string& owner, std::uint64_t id, const Upload& piece);

    Instruments& instruments_;
    Reply reply_;
    std::uint64_t ownerBytes_;
    UploadStore store_;
    EncoderPool thread_{1};  // last: ends first
};

}  // namespace lumulus::service
