#pragma once

#include <functional>
#include <optional>

#include "service/net/encoder_pool.h"
#include "service/protocol/message.h"
#include "service/protocol/requests.h"
#include "service/render/render_service.h"

namespace lumulus::service {

/// Joins the render service, which knows values, with the protocol, which encodes them. Pictures are encoded on threads
/// of their own, so that the next one is drawn meanwhile.
class RenderBridge {
  public:
    /// Takes a message for a client; `frame` tells that it is a picture, whose departure is to be told by frameSent().
    /// Called on any thread, and while the service is locked: it must not call the service.
    using Send = std::function<void(ClientId, Message, bool frame)>;

    /// Errors: those of RenderService.
    RenderBridge(const RenderConfig& config, Metrics& metrics, Send send);
    RenderBridge(const RenderBridge&) = delete;
    RenderBridge& operator=(const RenderBridge&) = delete;
    ~RenderBridge();

    RenderService& service() { return service_; }

  private:
    RenderService::Outlets outlets();
    void encode(const FrameTask& task);

    Send send_;
    EncoderPool encoders_;
    RenderService service_;  // last: it hands pictures to the encoders
};

/// The request as one of those that the render service answers; none for those that the connection answers.
std::optional<RenderRequest> renderRequest(Request request);

}  // namespace lumulus::service
