#include "service/telemetry/event_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace lumulus::service {

void logEvent(std::string_view level, std::string_view event, const nlohmann::json& fields) {
    const auto now = std::chrono::system_clock::now();
    const auto milliseconds =
        std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
    nlohmann::ordered_json line{
        {"time", fmt::format("{:%FT%T}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)), milliseconds)},
        {"level", level},
        {"event", event}};
    for (const auto& [name, value] : fields.items()) line[name] = value;
    // one call, so that lines of several threads do not mix
    const std::string text = line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace lumulus::service
