#include "service/telemetry/metrics.h"

#include <fmt/format.h>

#include <string_view>

namespace lumulus::service {
namespace {

struct Description {
    std::string_view name, type, help;
};

/// In the order of Metrics::Name.
constexpr std::array<Description, Metrics::names> descriptions{{
    {"connections_total", "counter", "Connections accepted"},
    {"connections_open", "gauge", "Connections open now"},
    {"connections_refused_total", "counter", "Connections refused: too many were open"},
    {"requests_total", "counter", "Requests understood"},
    {"requests_refused_total", "counter", "Requests answered with an error"},
    {"tokens_refused_total", "counter", "Connections that ended before a valid hello"},
    {"frames_total", "counter", "Frames made"},
    {"frames_superseded_total", "counter", "Frames that a newer request replaced"},
    {"frames_reduced_total", "counter", "Frames drawn with fewer pixels to keep a deadline"},
    {"deadlines_missed_total", "counter", "Frames that came later than their budget"},
    {"generations_total", "counter", "Photon generations traced"},
    {"scenes_loaded_total", "counter", "Scenes loaded"},
    {"scenes_held", "gauge", "Scenes in memory"},
    {"streams_running", "gauge", "Streams running"},
    {"uploads_total", "counter", "Uploads completed"},
    {"uploads_failed_total", "counter", "Uploads that failed"},
    {"received_bytes_total", "counter", "Bytes read from clients"},
    {"sent_bytes_total", "counter", "Bytes written to clients"},
    {"timeouts_total", "counter", "Connections closed for being slow or silent"},
}};

}  // namespace

void Metrics::frameLatency(double seconds) {
    std::size_t bucket = 0;
    while (bucket < bounds.size() && seconds > bounds.at(bucket)) ++bucket;
    latencies_.at(bucket).fetch_add(1, std::memory_order_relaxed);
    latencySum_.fetch_add(seconds, std::memory_order_relaxed);
}

std::string Metrics::prometheus() const {
    std::string text;
    for (std::size_t i = 0; i < names; ++i) {
        const Description& d = descriptions.at(i);
        text += fmt::format("# HELP lumulus_{0} {1}.\n# TYPE lumulus_{0} {2}\nlumulus_{0} {3}\n", d.name, d.help,
                            d.type, get(static_cast<Name>(i)));
    }
    text +=
        "# HELP lumulus_frame_seconds From a request's arrival to its frame.\n"
        "# TYPE lumulus_frame_seconds histogram\n";
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < latencies_.size(); ++i) {
        count += latencies_.at(i).load(std::memory_order_relaxed);
        text += fmt::format("lumulus_frame_seconds_bucket{{le=\"{}\"}} {}\n",
                            i < bounds.size() ? fmt::format("{}", bounds.at(i)) : "+Inf", count);
    }
    return text +
           fmt::format("lumulus_frame_seconds_sum {}\nlumulus_frame_seconds_count {}\n", latencySum_.load(), count);
}

std::string Metrics::json() const {
    std::string text;
    for (std::size_t i = 0; i < names; ++i)
        text += fmt::format("{}\"{}\":{}", i == 0 ? "{" : ",", descriptions.at(i).name, get(static_cast<Name>(i)));
    return text + "}";
}

}  // namespace lumulus::service
