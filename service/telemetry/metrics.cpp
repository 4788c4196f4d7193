#include "service/telemetry/metrics.h"

#include <prometheus/text_serializer.h>

#include <cassert>

namespace lumulus::service {
namespace {

struct Description {
    std::string_view name;
    bool counts = false;  ///< a counter; else a gauge
    std::string_view help;
};

/// In the order of Metrics::Name.
constexpr std::array<Description, Metrics::names> descriptions{{
    {"connections_total", true, "Connections accepted"},
    {"connections_open", false, "Connections open now"},
    {"connections_refused_total", true, "Connections refused: too many were open"},
    {"requests_total", true, "Requests understood"},
    {"requests_refused_total", true, "Requests answered with an error"},
    {"tokens_refused_total", true, "Wrong tokens"},
    {"frames_total", true, "Frames made"},
    {"frames_superseded_total", true, "Frames that a newer request replaced"},
    {"frames_reduced_total", true, "Frames drawn with fewer pixels to keep a deadline"},
    {"deadlines_missed_total", true, "Frames that came later than their budget"},
    {"generations_total", true, "Photon generations traced"},
    {"scenes_loaded_total", true, "Scenes loaded"},
    {"scenes_held", false, "Scenes in memory"},
    {"streams_running", false, "Streams running"},
    {"uploads_total", true, "Uploads completed"},
    {"uploads_failed_total", true, "Uploads that failed"},
    {"received_bytes_total", true, "Bytes read from clients"},
    {"sent_bytes_total", true, "Bytes written to clients"},
    {"timeouts_total", true, "Connections closed for being slow or silent"},
    {"encoder_waits_total", true, "Times that drawing waited for pictures to be encoded"},
    {"log_lines_lost_total", true, "Lines of the log that stderr did not take"},
    {"io_longest_handler_microseconds", false, "Longest time that the thread of the sockets was at one thing"},
    {"io_slow_handlers_total", true, "Times that it was at one thing for more than 10 ms"},
    {"memory_limit_bytes", false, "Memory that clients may make the service hold"},
    {"memory_bytes", false, "Memory that clients make the service hold"},
    {"memory_messages_bytes", false, "Of it, messages on their way in and replies on their way out"},
    {"memory_uploads_bytes", false, "Of it, pieces of uploads"},
    {"memory_frames_bytes", false, "Of it, pictures, drawn or encoded"},
    {"memory_scenes_bytes", false, "Of it, scenes"},
    {"memory_refusals_total", true, "Times that there was no memory for what a client asked"},
}};

/// Of the histogram's buckets [s].
prometheus::Histogram::BucketBoundaries latencyBounds() {
    return {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0};
}

}  // namespace

Metrics::Metrics() {
    for (std::size_t i = 0; i < names; ++i) {
        const Description& d = descriptions.at(i);
        const std::string name = "lumulus_" + std::string(d.name), help = std::string(d.help) + ".";
        if (d.counts)
            values_.at(i).counter = &prometheus::BuildCounter().Name(name).Help(help).Register(registry_).Add({});
        else
            values_.at(i).gauge = &prometheus::BuildGauge().Name(name).Help(help).Register(registry_).Add({});
    }
    latencies_ = &prometheus::BuildHistogram()
                      .Name("lumulus_frame_seconds")
                      .Help("From a request's arrival to its frame.")
                      .Register(registry_)
                      .Add({}, latencyBounds());
}

void Metrics::add(Name name, std::int64_t value) {
    const Value& to = values_.at(name);
    if (to.counter != nullptr)
        to.counter->Increment(static_cast<double>(value));
    else
        to.gauge->Increment(static_cast<double>(value));
}

void Metrics::set(Name name, std::int64_t value) {
    assert(values_.at(name).gauge != nullptr);
    values_.at(name).gauge->Set(static_cast<double>(value));
}

std::string Metrics::prometheus() const {
    return prometheus::TextSerializer().Serialize(registry_.Collect());
}

std::vector<std::pair<std::string_view, std::int64_t>> Metrics::values() const {
    std::vector<std::pair<std::string_view, std::int64_t>> result;
    for (std::size_t i = 0; i < names; ++i) {
        const Value& value = values_.at(i);
        const double now = value.counter != nullptr ? value.counter->Value() : value.gauge->Value();
        result.emplace_back(descriptions.at(i).name, static_cast<std::int64_t>(now));
    }
    return result;
}

}  // namespace lumulus::service
