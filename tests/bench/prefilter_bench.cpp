// Filtered importance sampling and the thesis's cones against the sum over all texels, on a clear sky without its sun,
// in one run and on the same cores: prefilter_bench [ELEVATION]. Errors are relative rms over directions all around, of
// what a viewer reads of the maps; times are of a core.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdlib>
#include <vector>

#include "bench/texel_sum.h"
#include "prefilter/cone.h"
#include "prefilter/layouts.h"
#include "prefilter/prefilter.h"

namespace lumulus::bench {
namespace {

constexpr int asked = 500;  // directions at which errors are measured

const Check never = [] {};

/// Time of all cores, which other work on the machine lengthens less than that of the clock.
template <class Work>
double secondsOf(const Work& work) {
    const auto now = [] {
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
    };
    const double start = now();
    work();
    return now() - start;
}

std::vector<glm::vec3> read(std::span<const glm::vec3> level, int size, std::span<const glm::vec3> directions) {
    std::vector<glm::vec3> values;
    for (const glm::vec3& direction : directions) values.push_back(readCube(level, size, direction));
    return values;
}

/// The texel sum for as many directions as a level has pixels: over all texels, and over as few as have no larger an
/// error.
void compareWithSums(const prefilter::Panorama& sky, double alpha, int size, std::span<const glm::vec3> truth,
                     double error, double seconds) {
    const std::vector<glm::vec3> directions = evenDirections(asked);
    const double times = 6.0 * size * size / asked;
    for (int smaller = 1; sky.height / smaller >= 4; smaller *= 2) {
        const prefilter::Panorama fewer = reduced(sky, smaller);
        std::vector<glm::vec3> values;
        const double took = times * secondsOf([&] { values = texelSum(fewer, alpha, directions); });
        const double off = relativeError(values, truth);
        if (smaller > 1 && off > error) break;
        fmt::print("      sum over {:4} x {:3}: {:.4f}, {:8.3f} s, {:6.1f} times as long\n", fewer.width, fewer.height,
                   off, took, took / seconds);
    }
}

void compareLevels(const prefilter::Panorama& sky, int size, int levels) {
    const std::vector<glm::vec3> directions = evenDirections(asked);
    prefilter::CubeMap cube(sky, 1, never);
    const double making = secondsOf([&] { cube = prefilter::CubeMap(sky, size, never); });
    fmt::print("cube of {} x {} from {} x {}: {:.3f} s\n", size, size, sky.width, sky.height, making);
    for (int level = 1; level < levels; ++level) {
        const double roughness = static_cast<double>(level) / (levels - 1), alpha = roughness * roughness;
        const int edge = size >> level;
        const std::vector<glm::vec3> truth = texelSum(sky, alpha, directions);
        const std::vector<glm::vec3> pixels = prefilter::openExrCube(edge);
        for (const prefilter::LobeOptions& options : {prefilter::LobeOptions{}, {0, 4.0}, {64, 1.0}, {64, 4.0}}) {
            const prefilter::Lobe lobe = prefilter::ggxLobe(alpha, size, 0.0, options);
            std::vector<glm::vec3> values;
            const double took = secondsOf([&] { values = prefilter::filtered(cube, lobe, pixels, never); });
            const double at = relativeError(prefilter::filtered(cube, lobe, directions, never), truth);
            const double seen = relativeError(read(values, edge, directions), truth);
            const std::uint32_t samples = options.samples > 0 ? options.samples : prefilter::usualSamples(alpha);
            fmt::print("roughness {:.2f}, {:3} x {:3}, {:4} samples, K {}: {:.4f} at a pixel, {:.4f} read, {:.3f} s\n",
                       roughness, edge, edge, samples, options.blur, at, seen, took);
            if (options.samples == 0 && options.blur == 1.0) compareWithSums(sky, alpha, edge, truth, at, took);
        }
    }
}

void compareThesis(const prefilter::Panorama& sky) {
    constexpr int size = 1024;
    const std::vector<glm::vec3> directions = evenDirections(asked);
    prefilter::CubeMap cube(sky, 1, never);
    const double making = secondsOf([&] { cube = prefilter::CubeMap(sky, size, never); });
    double cones = making, ours = making;
    for (std::size_t level = 1; level < prefilter::coneLevels.size(); ++level) {
        const auto& [roughness, angle] = prefilter::coneLevels[level];
        const int edge = size >> level;
        const std::vector<glm::vec3> pixels = prefilter::openExrCube(edge);
        std::vector<glm::vec3> values;
        const double took = secondsOf([&] { values = prefilter::coneMeans(cube, angle, pixels, never); });
        cones += took;
        const double alpha = roughness * roughness;
        ours += secondsOf([&] { prefilter::filtered(cube, prefilter::ggxLobe(alpha, size, 0.0), pixels, never); });
        const auto error = [&](double width) {
            const std::vector<glm::vec3> truth = texelSum(sky, width, directions);
            return relativeError(read(values, edge, directions), truth);
        };
        fmt::print(
            "thesis, roughness {:.2f}, {:4} x {:4}: {:.4f} against alpha = roughness^2, {:.4f} against roughness, "
            "{:.3f} s\n",
            roughness, edge, edge, error(alpha), error(roughness), took);
    }
    fmt::print("thesis, all levels: {:.2f} s; the same levels by filtered sampling: {:.2f} s\n", cones, ours);
}

}  // namespace
}  // namespace lumulus::bench

int main(int argc, char** argv) {
    const double elevation = argc > 1 ? std::atof(argv[1]) : 35.0;
    const lumulus::prefilter::Panorama sky = lumulus::bench::clearSky(elevation, 512);
    lumulus::bench::compareLevels(sky, 256, 5);
    lumulus::bench::compareThesis(sky);
}
