#include "bench/machine_peaks.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <vector>

namespace lumulus::bench {

namespace {

constexpr int repeats = 5;

double bestSeconds(const std::function<void()>& work) {
    double best = 1e30;
    for (int i = 0; i < repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

/// Independent multiply-adds in registers; the result keeps the compiler from leaving them out.
float multiplyAdds(int rounds, float factor) {
    std::array<float, 64> values{};
    for (int round = 0; round < rounds; ++round)
        for (float& value : values) value = value * factor + 1.0F;
    float sum = 0.0F;
    for (const float value : values) sum += value;
    return sum;
}

}  // namespace

MachinePeaks measurePeaks() {
    const int threads = tbb::info::default_concurrency();
    constexpr int rounds = 4000000;
    std::atomic<float> sink{0.5F};
    const double computing = bestSeconds([&] {
        tbb::parallel_for(0, threads,
                          [&](int) { sink.store(multiplyAdds(rounds, sink.load() > 1e30F ? 2.0F : 0.5F)); });
    });
    const std::size_t count = std::size_t{1} << 24U;
    std::vector<float> from(count, 1.0F), to(count, 0.0F);
    const double copying = bestSeconds([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) to[i] = 2.0F * from[i];
        });
    });
    return {2.0 * 64.0 * rounds * threads / computing, 2.0 * sizeof(float) * static_cast<double>(count) / copying};
}

}  // namespace lumulus::bench
