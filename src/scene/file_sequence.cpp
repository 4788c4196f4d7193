#include "scene/file_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/frame_name.h"
#include "scene/check_file.h"

namespace lumulus::scene {

namespace {

bool isThere(const std::filesystem::path& file, std::span<const std::filesystem::path> allowed) {
    std::error_code ec;
    return isAllowed(file, allowed) && std::filesystem::is_regular_file(file, ec);
}

/// Numbers of files before one that is missing among which one is looked for, where the sequence has no first one.
constexpr std::int64_t farthest = 1000;
/// Moments nearer to a file than this are at it: rounding.
constexpr double atFile = 1e-6;

/// Number of the file at a frame, as it would be if files went on for ever, with a fraction.
double endlessFile(const FileSequence& sequence, double frame, double fps) {
    const double rate = sequence.speed * (sequence.fps > 0.0 ? sequence.fps / fps : 1.0);
    const double first = sequence.frames ? static_cast<double>(sequence.frames->x) : 0.0;
    const double wanted = first + sequence.offset + rate * (frame - first);
    return std::abs(wanted - std::round(wanted)) < atFile ? std::round(wanted) : wanted;
}

double within(double value, double period) {
    return value - period * std::floor(value / period);
}

/// What lies `wanted` files from the beginning, by what the sequence says of times beyond its ends. `high`: where its
/// last file ends, `period` how long it is till it begins again.
std::optional<double> extended(const FileSequence& sequence, double wanted, double period) {
    const auto low = static_cast<double>(sequence.frames->x), high = static_cast<double>(sequence.frames->y);
    if (wanted >= low && wanted <= high) return wanted;
    switch (sequence.extend) {
        case Extend::hold:
            return std::clamp(wanted, low, high);
        case Extend::repeat:
            return low + within(wanted - low, period);
        case Extend::pingPong: {
            if (high == low) return low;
            const double place = within(wanted - low, 2.0 * (high - low));
            return low + std::min(place, 2.0 * (high - low) - place);
        }
        case Extend::clip:
            break;
    }
    return std::nullopt;
}

/// The file behind another one: behind the last of those that repeat comes the first.
std::int64_t fileBehind(const FileSequence& sequence, std::int64_t file) {
    return sequence.frames && file == sequence.frames->y ? sequence.frames->x : file + 1;
}

/// The file that is there before a missing one; none where the sequence has none.
std::optional<std::int64_t> fileBefore(const FileSequence& sequence, const std::filesystem::path& name,
                                       std::int64_t missing, std::span<const std::filesystem::path> allowed) {
    const std::int64_t low = sequence.frames ? sequence.frames->x : std::max<std::int64_t>(0, missing - farthest);
    for (std::int64_t before = missing - 1; before >= low; --before)
        if (isThere(nameOfFrame(name, before), allowed)) return before;
    return std::nullopt;
}

/// What is shown at a frame; infinite where nothing is.
double shownAt(const FileSequence& sequence, double frame, double fps) {
    constexpr double nothing = std::numeric_limits<double>::infinity();
    if (sequence.interpolate) return momentAt(sequence, frame, fps).value_or(nothing);
    const std::optional<std::int64_t> file = fileAt(sequence, frame, fps);
    return file ? static_cast<double>(*file) : nothing;
}

}  // namespace

std::optional<std::int64_t> fileAt(const FileSequence& sequence, double frame, double fps) {
    const double wanted = std::floor(endlessFile(sequence, frame, fps) + 0.5);
    if (!sequence.frames) return static_cast<std::int64_t>(wanted);
    const auto count = static_cast<double>(sequence.frames->y - sequence.frames->x + 1);
    const std::optional<double> file = extended(sequence, wanted, count);
    return file ? std::optional(static_cast<std::int64_t>(*file)) : std::nullopt;
}

std::optional<double> momentAt(const FileSequence& sequence, double frame, double fps) {
    const double wanted = endlessFile(sequence, frame, fps);
    if (!sequence.frames) return wanted;
    return extended(sequence, wanted, static_cast<double>(sequence.frames->y - sequence.frames->x + 1));
}

void chooseFile(Cloud& cloud, double frame, double fps, std::span<const std::filesystem::path> allowed,
                const std::string& where) {
    if (!hasFrameNumber(cloud.vdb) || isThere(cloud.vdb, allowed)) return;
    const FileSequence& sequence = cloud.sequence;
    const std::filesystem::path name = cloud.vdb;
    const double moment = shownAt(sequence, frame, fps);
    if (std::isinf(moment)) {  // not there: nothing scatters
        cloud.extinction = 0.0;
        cloud.vdb = nameOfFrame(name, sequence.frames->x);
        return;
    }
    const auto number = static_cast<std::int64_t>(std::floor(moment));
    if (number < 0)
        throw InputError(fmt::format("frame {} would show file number {}", frame, number), where,
                         "give frames = [first, last], or another offset");
    cloud.moment = SequenceMoment{name, moment, sequence.fps > 0.0 ? sequence.fps : fps, {}};
    cloud.vdb = nameOfFrame(name, number);
    if (cloud.moment->share() > 0.0) cloud.moment->next = nameOfFrame(name, fileBehind(sequence, number));
    for (const auto& [file, of] : {std::pair(cloud.vdb, number), std::pair(cloud.moment->next, number + 1)}) {
        if (file.empty() || isThere(file, allowed)) continue;
        const std::optional<std::int64_t> before =
            sequence.holdMissing ? fileBefore(sequence, name, of, allowed) : std::nullopt;
        if (!before)
            throw InputError(fmt::format("frame {}: {} does not exist", of, file.string()), where,
                             "make it, or write missing = \"hold\"");
        cloud.held = file.string();
        cloud.vdb = nameOfFrame(name, *before);
        cloud.moment->file = static_cast<double>(*before);
        cloud.moment->next.clear();
        return;
    }
}

}  // namespace lumulus::scene
