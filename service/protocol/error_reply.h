#pragma once

#include <cstdint>
#include <string>

#include "service/protocol/message.h"

namespace lumulus::service {

/// An error reply: {"code", "message", "where"}. Long texts are shortened.
Message errorReply(std::uint64_t id, const std::string& code, const std::string& text, const std::string& where = {});

}  // namespace lumulus::service
