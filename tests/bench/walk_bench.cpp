// The GPU's photon walk against plain C++ ones on the same cores, in one run, and against what the machine could do at
// best: walk_bench SCENE [section.key=value…], for example walk_bench configs/scenes/cumulus-side-lit.toml. Fails where
// the two do not find the same light.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench_main.h"
#include "bench/machine_peaks.h"
#include "bench/plain_walk.h"
#include "gpu/context.h"
#include "scene/load.h"
#include "support/first_volume.h"

namespace lumulus::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t photons = 100000;  // of a generation
constexpr int generations = 5;             // of a turn
constexpr int turns = 5;                   // of each, in alternation: other work on the machine meets both

/// Seconds of all threads of this process.
double cpuSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// By the clock, and in time of the cores, which other work on the machine lengthens less.
struct Duration {
    double wall = 0.0, cpu = 0.0;
};

template <class Work>
Duration timeOf(const Work& work) {
    const double cpu = cpuSeconds();
    const Clock::time_point start = Clock::now();
    work();
    return {std::chrono::duration<double>(Clock::now() - start).count(), cpuSeconds() - cpu};
}

struct Measured {
    std::vector<Duration> times;
    double events = 0.0, nulls = 0.0, records = 0.0;
    std::vector<double> light;  ///< by channel: sums of the coefficients of y_00 [W]

    double photonCount() const { return static_cast<double>(times.size()) * generations * photons; }
    /// Seconds of all turns, by the median.
    double total(double Duration::*clock) const {
        std::vector<double> sorted;
        for (const Duration& time : times) sorted.push_back(time.*clock);
        std::sort(sorted.begin(), sorted.end());
        return static_cast<double>(sorted.size()) * sorted[sorted.size() / 2];
    }
    double rate(double Duration::*clock) const { return events / total(clock); }  ///< collisions a second
};

photon::Medium mediumOf(const scene::Scene& scene, const vdb::Volume& volume) {
    const scene::Cloud& cloud = scene.clouds.at(0);
    return {cloud.extinction * cloud.densityScale * static_cast<double>(volume.maximum), cloud.albedo,
            phase::makeScatteringTables(cloud.phase, glm::radians(scene.photonMap.forwardCut), cloud.albedo,
                                        PlainWalk::bands, glm::radians(scene.sun.angularDiameter))};
}

cloud::PrepareOptions prepareOptions(const scene::Scene& scene, const photon::Medium& medium) {
    cloud::PrepareOptions options;
    options.preparation = scene.preparation;
    options.majorant = scene.photonMap.majorant;
    options.reducedExtinction = medium.extinction * static_cast<double>(medium.tables.scatterFraction) *
                                (1.0 - static_cast<double>(medium.tables.bandMoments[1]));
    return options;
}

template <class Number>
void addLight(std::vector<double>& light, const std::vector<Number>& sums, double unit) {
    constexpr std::size_t each = PlainWalk::bands * PlainWalk::bands;
    light.resize(3, 0.0);
    for (std::size_t i = 0; i < sums.size(); i += each) light[i / each % 3] += static_cast<double>(sums[i]) * unit;
}

void measureGpu(Measured& gpu, photon::PhotonMap& map, const scene::Scene& scene) {
    const photon::Counters before = map.counters();
    gpu.times.push_back(timeOf([&] {
        for (int i = 0; i < generations; ++i) map.trace(scene.sun, scene.sky);
        map.settle();
    }));
    gpu.events += static_cast<double>(map.counters().events - before.events);
    gpu.nulls += static_cast<double>(map.counters().nulls - before.nulls);
    gpu.records += static_cast<double>(map.counters().records - before.records);
}

template <class Number>
void measurePlain(Measured& plain, const PlainWalk& walk, const scene::Scene& scene, std::uint64_t seed) {
    WalkResult<Number> result;
    plain.times.push_back(
        timeOf([&] { result = walk.trace<Number>(scene.sun, scene.sky, generations * photons, seed); }));
    plain.events += static_cast<double>(result.events);
    plain.nulls += static_cast<double>(result.nulls);
    plain.records += static_cast<double>(result.records);
    addLight(plain.light, result.sums, result.unit / turns);
}

/// Seconds that the GPU's work takes at least. Operations counted in the shaders, on the low side: a tentative
/// collision takes 110 (random numbers 80, logarithm 20, a look-up 10), the step to it 45; a real one 100 (phase
/// function, rotation); a record 530, of which 110 are 36 harmonics and 324 their sums. Bytes: a
/// record is written and read, then its sorted copy, 56; each collector's coefficients are read and written once a
/// generation. The volume is taken to stay in the caches.
double floorSeconds(const Measured& gpu, std::size_t collectors, const MachinePeaks& peaks, double& bytesSeconds) {
    const double operations = 155.0 * (gpu.events + gpu.nulls) + 100.0 * gpu.events + 530.0 * gpu.records;
    const double flushed = static_cast<double>(collectors) * 3 * PlainWalk::bands * PlainWalk::bands * 16.0;
    const double bytes = 56.0 * gpu.records + flushed * generations * static_cast<double>(gpu.times.size());
    bytesSeconds = bytes / peaks.bytes;
    return operations / peaks.operations;
}

void require(bool good, const std::string& what) {
    if (!good) throw std::runtime_error("the walks differ in " + what);
}

/// The same work and the same light, within 1 % and noise: six standard errors of as many independent records, as those
/// of one photon come together.
void requireSame(const Measured& gpu, const Measured& plain) {
    const double tolerance = 0.01 + 6.0 / std::sqrt(plain.records);
    const auto near = [&](double a, double b) { return std::abs(a - b) <= tolerance * std::abs(b); };
    require(near(gpu.events, plain.events), fmt::format("collisions: {} and {}", gpu.events, plain.events));
    require(near(gpu.nulls, plain.nulls), fmt::format("null collisions: {} and {}", gpu.nulls, plain.nulls));
    require(near(gpu.records, plain.records), fmt::format("records: {} and {}", gpu.records, plain.records));
    for (std::size_t i = 0; i < 3; ++i)
        require(near(gpu.light[i], plain.light[i]), fmt::format("light: {} and {}", gpu.light[i], plain.light[i]));
}

void printRates(const Measured& gpu, const Measured& plain, const Measured& exact) {
    fmt::print("{:>32}{:>14}{:>14}{:>14}{:>14}\n", "GPU walk", "C++, floats", "ratio", "C++, integers", "ratio");
    for (const auto& [name, clock] :
         {std::pair("collisions a second", &Duration::wall), std::pair("… of one core's time", &Duration::cpu)})
        fmt::print("{:<20}{:>12.3g}{:>14.3g}{:>14.2f}{:>14.3g}{:>14.2f}\n", name, gpu.rate(clock), plain.rate(clock),
                   gpu.rate(clock) / plain.rate(clock), exact.rate(clock), gpu.rate(clock) / exact.rate(clock));
}

void printFloor(const Measured& gpu, std::size_t collectors) {
    const MachinePeaks peaks = measurePeaks();
    double bytes = 0.0;
    const double operations = floorSeconds(gpu, collectors, peaks, bytes), taken = gpu.total(&Duration::wall);
    fmt::print("machine: {:.3g} operations a second, {:.3g} bytes a second\n", peaks.operations, peaks.bytes);
    fmt::print("time over the floor: {:.1f} (operations {:.3f} s, bytes {:.3f} s, taken {:.3f} s)\n",
               taken / std::max(operations, bytes), operations, bytes, taken);
}

/// Each pass beside the whole walk in C++: by time of the cores, so that other work on the machine does not matter.
void printPasses(const photon::PhotonMap& map, const Measured& gpu, const Measured& plain) {
    double all = 0.0;
    for (const gpu::PassTime& pass : map.times()) all += pass.milliseconds;
    const double share = plain.rate(&Duration::cpu) / gpu.rate(&Duration::cpu);
    for (const gpu::PassTime& pass : map.times())
        fmt::print("{:<12}{:>8.1f} ms a generation, {:>5.1f} % of C++ with floats\n", pass.name,
                   pass.milliseconds / ((turns + 1.0) * generations), 100.0 * share * pass.milliseconds / all);
}

void run(const std::string& path, const std::vector<std::string>& overrides) {
    const scene::Scene scene = scene::loadScene(path, overrides);
    const vdb::Volume volume = test::firstVolume(scene);
    const photon::Medium medium = mediumOf(scene, volume);
    gpu::Context context({});
    const cloud::Asset cloud = cloud::prepare(context, volume, prepareOptions(scene, medium));
    photon::Options options;
    options.photonsPerGeneration = photons;
    options.bands = PlainWalk::bands;
    photon::PhotonMap map(context, cloud, medium, options);
    const PlainWalk walk(volume, cloud, medium);

    Measured gpu, plain, exact, warmUp;
    measureGpu(warmUp, map, scene);  // compiles the shaders
    measurePlain<float>(warmUp, walk, scene, 0);
    for (int turn = 1; turn <= turns; ++turn) {
        measureGpu(gpu, map, scene);
        measurePlain<float>(plain, walk, scene, static_cast<std::uint64_t>(turn));
        measurePlain<std::int64_t>(exact, walk, scene, static_cast<std::uint64_t>(turn));
    }
    addLight(gpu.light, map.downloadSum(), map.unit() / ((turns + 1.0) * generations));
    requireSame(gpu, plain);
    requireSame(gpu, exact);
    fmt::print("{} collectors, {} bands, RGB; a photon has {:.2f} collisions, {:.2f} null collisions, {:.2f} records\n",
               cloud.collectors.size(), PlainWalk::bands, gpu.events / gpu.photonCount(), gpu.nulls / gpu.photonCount(),
               gpu.records / gpu.photonCount());
    printRates(gpu, plain, exact);
    printFloor(gpu, cloud.collectors.size());
    printPasses(map, gpu, plain);
}

}  // namespace

}  // namespace lumulus::bench

int main(int argc, char** argv) {
    return lumulus::bench::benchMain("walk_bench", argc, argv, lumulus::bench::run);
}
