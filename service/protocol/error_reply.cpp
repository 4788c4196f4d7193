#include "service/protocol/error_reply.h"

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace lumulus::service {

Message errorReply(std::uint64_t id, const std::string& code, const std::string& text, const std::string& where) {
    nlohmann::json body{{"code", code}, {"message", shortened(oneLine(text), 800)}};
    if (!where.empty()) body["where"] = shortened(oneLine(where), 200);
    return {MessageType::error, id, body.dump(), {}};
}

}  // namespace lumulus::service
