#include "service/telemetry/event_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <climits>
#include <nlohmann/json.hpp>

namespace lumulus::service {
namespace {

constexpr std::size_t longestText = 600;  // bytes of a field, where the line is too long

std::string lineOf(std::string_view level, std::string_view name, const nlohmann::json& fields) {
    const auto now = std::chrono::system_clock::now();
    const auto milliseconds =
        std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
    nlohmann::ordered_json line{
        {"time", fmt::format("{:%FT%T}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)), milliseconds)},
        {"level", level},
        {"event", name}};
    for (const auto& [key, value] : fields.items()) line[key] = value;
    return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

nlohmann::json withShortTexts(nlohmann::json fields) {
    for (auto& value : fields)
        if (value.is_string()) value = value.get_ref<const std::string&>().substr(0, longestText);
    return fields;
}

/// Writes at most PIPE_BUF bytes, or none: a pipe, a socket or a terminal that is ready for output takes so many
/// without waiting.
bool putAtOnce(const std::string& line) {
    ::pollfd to{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&to, 1, 0) != 1 || (to.revents & POLLOUT) == 0) return false;
    return ::write(STDERR_FILENO, line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

}  // namespace

void EventLog::event(std::string_view level, std::string_view name, const nlohmann::json& fields) {
    std::string line = lineOf(level, name, fields);
    if (line.size() > PIPE_BUF) line = lineOf(level, name, withShortTexts(fields));
    if (line.size() > PIPE_BUF) line = lineOf(level, name, {{"too_long", true}});
    const std::lock_guard lock(mutex_);
    if (lost_ > 0 && putAtOnce(lineOf("warning", "log_lines_lost", {{"lines", lost_}}))) lost_ = 0;
    if (lost_ == 0 && putAtOnce(line)) return;
    ++lost_;
    metrics_.add(Metrics::logLinesLost);
}

}  // namespace lumulus::service
