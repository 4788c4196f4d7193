#pragma once

#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// The log on stderr: one line of JSON an event, {"time", "level", "event", …}. For any thread. Never waits for whoever
/// reads stderr: lines that it does not take at once are lost and counted, in Metrics::logLinesLost and in an event
/// `log_lines_lost` when lines go through again.
class EventLog {
  public:
    explicit EventLog(Metrics& metrics) : metrics_(metrics) {}
    EventLog(const EventLog&) = delete;
    EventLog& operator=(const EventLog&) = delete;

    /// `fields` is an object, or null for none.
    void event(std::string_view level, std::string_view name, const nlohmann::json& fields);

  private:
    Metrics& metrics_;
    std::mutex mutex_;  // guards what follows, and keeps lines apart
    std::uint64_t lost_ = 0;
};

}  // namespace lumulus::service
