#pragma once

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lumulus::service {

/// Counters and gauges of the service; any thread adds to them.
class Metrics {
  public:
    enum Name {
        connectionsOpened,
        connectionsOpen,
        connectionsRefused,
        requestsTotal,
        requestsRefused,
        tokensRefused,
        framesSent,
        framesSuperseded,
        framesReduced,
        deadlinesMissed,
        generationsTraced,
        scenesLoaded,
        scenesHeld,
        streamsRunning,
        uploadsCompleted,
        uploadsFailed,
        bytesReceived,
        bytesSent,
        timeouts,
        encoderWaits,
        logLinesLost,
        longestHandler,
        slowHandlers,
        memoryLimit,
        memoryUsed,
        memoryMessages,
        memoryUploads,
        memoryFrames,
        memoryScenes,
        memoryRefusals,
        names
    };

    Metrics();

    void add(Name name, std::int64_t value = 1);
    /// Gauges alone.
    void set(Name name, std::int64_t value);
    /// Takes the seconds from a request's arrival to the hand-over of its frame.
    void frameLatency(double seconds) { latencies_->Observe(seconds); }

    /// In Prometheus' text format, version 0.0.4.
    std::string prometheus() const;
    /// Counters and gauges by name, without the prefix that they have in Prometheus' format.
    std::vector<std::pair<std::string_view, std::int64_t>> values() const;

  private:
    struct Value {
        prometheus::Counter* counter = nullptr;  // one of the two
        prometheus::Gauge* gauge = nullptr;
    };

    prometheus::Registry registry_;
    std::array<Value, names> values_;
    prometheus::Histogram* latencies_;
};

}  // namespace lumulus::service
