#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

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
        names
    };

    void add(Name name, std::int64_t value = 1) { values_.at(name).fetch_add(value, std::memory_order_relaxed); }
    void set(Name name, std::int64_t value) { values_.at(name).store(value, std::memory_order_relaxed); }
    std::int64_t get(Name name) const { return values_.at(name).load(std::memory_order_relaxed); }
    /// From a request's arrival to the hand-over of its frame.
    void frameLatency(double seconds);

    /// In Prometheus' text format, version 0.0.4.
    std::string prometheus() const;
    /// As the fields of a JSON object's text: {"connections_open": 1, …}
    std::string json() const;

  private:
    static constexpr std::array<double, 12> bounds{0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0};

    std::array<std::atomic<std::int64_t>, names> values_{};
    std::array<std::atomic<std::uint64_t>, bounds.size() + 1> latencies_{};
    std::atomic<double> latencySum_{0.0};
};

}  // namespace lumulus::service
