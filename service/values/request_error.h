#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace lumulus::service {

/// Thrown where a request is refused. It becomes an error reply, and the connection goes on.
class RequestError : public std::runtime_error {
  public:
    RequestError(std::string errorCode, const std::string& text, std::string place = {})
        : std::runtime_error(text), code(std::move(errorCode)), where(std::move(place)) {}
    std::string code;   ///< one of those that docs/protocol.md lists
    std::string where;  ///< the field of the request that is to blame; empty where none is
};

}  // namespace lumulus::service
