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
struct ListUploads {};
struct DeleteUpload {
    std::string hash;  ///< 64 hexadecimal digits
};
struct Ping {};
struct ListScenes {};

using Request = std::variant<Hello, LoadScene, Upload, FrameRequest, StartStream, StopStream, Composite, Cancel,
                             StatisticsRequest, Ping, Change, ListUploads, DeleteUpload, ListScenes, QueryRequest>;

/// Reads a request from a message. Errors: RequestError `bad_request` (the field is named), `too_large`,
/// `unknown_type`.
Request parseRequest(Message message, const RequestLimits& limits);

/// The 64 digits 0-9 a-f of a SHA-256 that is spelled "sha256:…", or without what stands before them; none for another
/// text.
std::optional<std::string> digitsOfHash(std::string_view text);

/// The same of the field `where`. Errors: RequestError `bad_request` for another text.
std::string requireHash(const std::string& text, const char* where);

}  // namespace lumulus::service
