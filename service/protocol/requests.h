#pragma once

#include <string>
#include <variant>

#include "service/protocol/message.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Requests that the connection itself answers; the others are in service/values/requests.h.

struct Hello {
    std::string token;
    std::string client;  ///< a name for the log
};

struct StatisticsRequest {};
struct Ping {};
struct ListScenes {};

using Request = std::variant<Hello, LoadScene, Upload, FrameRequest, StartStream, StopStream, Composite, Cancel,
                             StatisticsRequest, Ping, Change, ListScenes>;

/// Reads a request from a message. Errors: RequestError `bad_request` (the field is named), `too_large`,
/// `unknown_type`.
Request parseRequest(Message message, const RequestLimits& limits);

/// Whether a text is a SHA-256: 64 digits 0-9 a-f.
bool isHash(const std::string& text);

}  // namespace lumulus::service
