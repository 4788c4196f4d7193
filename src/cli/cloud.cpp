#include "cli/cloud.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/frame_name.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "cli/output.h"
#include "job/frame_range.h"
#include "vdb/deform.h"
#include "vdb/procedural.h"
#include "vdb/write.h"

namespace lumulus::cli {

namespace {

/// Refuses speeds that are none, NaN among them.
void checkSpeeds(const CloudOptions& options) {
    constexpr double fastest = 1000.0;  // m/s
    const auto check = [&](double speed, const char* option) {
        if (!(std::abs(speed) <= fastest))
            throw InputError(fmt::format("{} m/s is no speed of a cloud", speed), option,
                             "give at most 1000 m/s for each direction");
    };
    for (const double speed : options.wind) check(speed, "--wind");
    check(options.swirl, "--swirl");
    if (!(options.fps > 0.0 && std::isfinite(options.fps)))
        throw InputError(fmt::format("{} frames a second cannot be", options.fps), "--fps", "give a number above 0");
}

/// Refuses what the last frame would be too large or too far away for, before anything is written.
void checkLast(const vdb::Volume& volume, const vdb::Flow& flow, double seconds, std::int64_t frame) {
    constexpr double mostVoxels = 134217728.0, farthest = 1e7;  // 512 MiB; metres
    const double voxels = vdb::voxelsOfDeformed(volume, flow, seconds);
    if (!(voxels <= mostVoxels))
        throw InputError(
            fmt::format("the cloud would be spread over {:.3g} million voxels at frame {}", 1e-6 * voxels, frame),
            "--swirl", "give fewer frames, a higher --fps or a lower speed");
    if (!(glm::length(flow.wind) * seconds <= farthest))
        throw InputError(fmt::format("the cloud would be {:.3g} km away at frame {}",
                                     1e-3 * glm::length(flow.wind) * seconds, frame),
                         "--wind", "give fewer frames, a higher --fps or a lower speed");
}

void writeFrames(const vdb::Volume& volume, const CloudOptions& options, Steps& steps) {
    const std::vector<std::int64_t> frames = job::parseFrames(options.frames).numbers();
    glm::dvec3 wind(0.0);
    for (std::size_t i = 0; i < options.wind.size(); ++i) wind[static_cast<int>(i)] = options.wind[i];
    const vdb::Flow flow(volume, wind, options.swirl);
    checkLast(volume, flow, static_cast<double>(frames.back()) / options.fps, frames.back());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        stopIfInterrupted();
        steps.report("writing", i, frames.size());
        const double seconds = static_cast<double>(frames[i]) / options.fps;
        const vdb::Volume moved = vdb::deformed(volume, flow, seconds);
        vdb::write(moved, vdb::velocitiesOf(moved, flow, seconds), nameOfFrame(options.output, frames[i]));
    }
    steps.report("writing", frames.size(), frames.size());
}

/// Checks the options before the work.
void checkOptions(const CloudOptions& options) {
    requireSuffix(options.output, {".vdb"});
    checkSpeeds(options);
    const bool moves = !options.wind.empty() || options.swirl != 0.0;
    if (options.frames.empty()) {
        if (moves)
            throw InputError("a cloud that moves is a file a frame", "--frames", "give FIRST-LAST, such as 0-23");
        checkWritable(options.output);
        return;
    }
    const std::vector<std::int64_t> frames = job::parseFrames(options.frames).numbers();
    if (!hasFrameNumber(options.output))
        throw InputError("the name has no place for the number of a frame", options.output.string(),
                         "write #### or %04d where the number goes");
    checkWritable(nameOfFrame(options.output, frames.front()));
}

}  // namespace

void runCloud(const CloudOptions& options) {
    checkOptions(options);
    Steps steps(options.quiet);
    const vdb::Volume volume = vdb::makeCloud({options.kind, options.resolution, options.seed}, steps.reporter());
    stopIfInterrupted();
    if (!options.frames.empty()) return writeFrames(volume, options, steps);
    steps.report("writing", 0, 1);
    vdb::write(volume, options.output);
    steps.report("writing", 1, 1);
}

}  // namespace lumulus::cli
