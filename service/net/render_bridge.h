#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "base/display_transform.h"
#include "service/net/encoder_pool.h"
#include "service/protocol/message.h"
#include "service/protocol/requests.h"
#include "service/render/render_service.h"
#include "service/render/server_paths.h"

namespace lumulus::service {

/// Joins the render service, which knows values, with the protocol, which encodes them. Pictures are encoded on threads
/// of their own, so that the next one is drawn meanwhile.
class RenderBridge {
  public:
    /// A message on its way to a client.
    struct Outbound {
        Message message;
        bool frame = false;          ///< a picture, whose departure is to be told by frameSent()
        MemoryBudget::Share memory;  ///< that it holds, where that is counted
    };
    /// Takes a message for a client. Called on any thread, and while the service is locked: it must not call the
    /// service.
    using Send = std::function<void(ClientId, Outbound)>;

    /// `begun` is RenderService::Outlets::begun. Errors: those of RenderService and DisplayTransform.
    RenderBridge(const RenderConfig& config, Instruments& instruments, Send send,
                 std::function<void(std::exception_ptr)> begun);
    RenderBridge(const RenderBridge&) = delete;
    RenderBridge& operator=(const RenderBridge&) = delete;
    ~RenderBridge();

    RenderService& service() { return service_; }
    /// Lets something end elsewhere than on the calling thread: that takes milliseconds of a large picture.
    void dispose(std::shared_ptr<void> gone);

  private:
    RenderService::Outlets outlets(std::function<void(std::exception_ptr)> begun);
    void encode(const FrameTask& task);

    MemoryBudget& memory_;
    ServerPaths paths_;
    Send send_;
    const std::optional<DisplayTransform> display_;  // of $OCIO
    EncoderPool encoders_;
    RenderService service_;  // last: it hands pictures to the encoders
};

/// The request as one of those that the render service answers; none for those that the connection answers.
std::optional<RenderRequest> renderRequest(Request request);

}  // namespace lumulus::service
