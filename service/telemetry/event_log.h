#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace lumulus::service {

/// Writes one line of JSON to stderr: {"time", "level", "event", …}. For any thread. `fields` is an object, or null for
/// none.
void logEvent(std::string_view level, std::string_view event, const nlohmann::json& fields);

}  // namespace lumulus::service
