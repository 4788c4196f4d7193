#include "cli/render_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/display_transform.h"
#include "base/error.h"
#include "base/frame_name.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/progress.h"
#include "cli/clouds_told.h"
#include "cli/output.h"
#include "cli/picture_files.h"
#include "cli/stats_json.h"
#include "job/frame_range.h"
#include "job/frame_renderer.h"
#include "job/whole_picture.h"
#include "light/map_file/map_file.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"
#include "volume/place_clouds.h"

namespace lumulus::cli {

namespace {

using Clock = std::chrono::steady_clock;

/// The scene of a render command at any frame.
class FrameScenes {
  public:
    explicit FrameScenes(const RenderOptions& options)
        : text_(scene::sceneText(options.scene)), quality_(options.quality), overrides_(options.overrides) {
        if (options.seed) overrides_.push_back("photon_map.seed=" + std::to_string(*options.seed));
    }
    scene::Scene at(std::int64_t frame) const {
        scene::Scene scene =
            scene::parseScene(text_.toml, text_.source, overrides_, quality_, {}, static_cast<double>(frame));
        scene::requireBoundedFog(scene);
        return scene;
    }

  private:
    scene::SceneText text_;
    std::optional<scene::Quality> quality_;
    std::vector<std::string> overrides_;
};

std::vector<std::filesystem::path> namesOf(const RenderOptions& options, std::int64_t frame) {
    std::vector<std::filesystem::path> names;
    for (const auto& output : options.outputs) names.push_back(nameOfFrame(output, frame));
    return names;
}

/// Checks the options before the work.
void checkOptions(const RenderOptions& options, std::int64_t firstFrame) {
    if (options.seconds || options.targetError)
        throw InputError("frames have the number of photons that their scene asks for",
                         options.seconds ? "--seconds" : "--target-error", "leave it out, or leave out --frames");
    if (options.maps.used())
        throw InputError("photon maps in files are of one picture", "--frames",
                         "leave it out, or leave out --map-in, --map-out and --generations");
    if (options.outputs.empty()) throw InputError("nothing is to be written", "-o", "give a picture");
    for (const auto& output : options.outputs) {
        requireSuffix(output, {".exr", ".png"});
        if (!hasFrameNumber(output))
            throw InputError("the name has no place for the number of a frame", output.string(),
                             "write #### or %04d where the number goes");
    }
    DisplayTransform::ofEnvironment();
    Steps silent(true);
    ErrorOfPicture(options.error, options.quality, silent);  // checks them
    std::vector<std::filesystem::path> places = namesOf(options, firstFrame);
    if (!options.stats.empty() && options.stats != "-") places.emplace_back(options.stats);
    checkPlaces(places);
}

/// A frame, and whether its files are there already.
struct Frame {
    std::int64_t frame = 0;
    std::int64_t number = 0;  ///< its place in the sequence
    bool isThere = false;
};

std::vector<Frame> framesOf(const RenderOptions& options, const std::vector<std::int64_t>& numbers) {
    std::vector<Frame> frames;
    for (const std::int64_t frame : numbers) {
        stopIfInterrupted();
        const bool there = options.skipExisting && std::ranges::all_of(namesOf(options, frame), job::isWholePicture);
        frames.push_back({frame, static_cast<std::int64_t>(frames.size()), there});
    }
    return frames;
}

/// Renders frames, and remembers what it has to tell of them.
class Frames {
  public:
    Frames(const RenderOptions& options, const FrameScenes& scenes)
        : options_(options), scenes_(scenes), renderer_(rendererOptions()) {}

    /// Where a sequence goes on that keeps light from frame to frame: behind the frame whose map was kept, where one
    /// before `missing` was, else at the beginning.
    std::int64_t resume(std::span<const Frame> frames, std::int64_t missing) {
        const std::filesystem::path file = keptMap(frames);
        if (missing == 0 || !std::filesystem::exists(file)) return 0;
        try {
            const map_file::MapFile map = map_file::readMap(file);
            const std::int64_t number = job::FrameRenderer::numberOf(map, scenes_.at(frames.front().frame));
            if (number >= missing) return 0;
            renderer_.resume(sceneOf(frames[static_cast<std::size_t>(number)]), number, map);
            return number + 1;
        } catch (const Error& e) {
            stopIfInterrupted();
            logWarning(fmt::format("{}: the frames before are traced again", e.what()));
            return 0;
        }
    }
    /// Traces a frame whose picture is there, for the frames behind it.
    void trace(const Frame& frame, const Frame* next) {
        attempt(frame, [&] {
            const std::optional<scene::Scene> behind = readable(next);
            renderer_.of(sceneOf(frame), frame.number, behind ? &*behind : nullptr);
        });
    }
    void render(const Frame& frame, const Frame* next) {
        const auto start = Clock::now();
        attempt(frame, [&] {
            const scene::Scene scene = sceneOf(frame);
            const std::optional<scene::Scene> behind = readable(next);
            Renderer& renderer = renderer_.of(scene, frame.number, behind ? &*behind : nullptr);
            View view;
            view.camera = scene.camera;
            view.image = scene.image;
            LayeredImage image = renderer.draw(view);
            stopIfInterrupted();
            const Statistics statistics = renderer.statistics();
            ErrorOfPicture error(options_.error, options_.quality, steps_);
            error.measure(image, scene, statistics.clouds, secondsSince(start), false);
            noteOrigin(image, scene, statistics);
            const auto writing = Clock::now();
            writePictures(namesOf(options_, frame.frame), image, scene.image);
            note(frame.frame, statistics, secondsSince(writing), secondsSince(start), error);
            requireNoMessages(options_.validate, statistics);
        });
    }
    /// Keeps the light of the last frame in a file, for a sequence that is broken off: now and then, so that it costs
    /// little beside the frames, or at once.
    void keepLight(std::span<const Frame> frames, bool atOnce) {
        constexpr double share = 20.0;
        if (!atOnce && secondsSince(kept_) < share * keeping_) return;
        const auto start = Clock::now();
        if (const auto map = renderer_.map()) map_file::writeMap(keptMap(frames), *map);
        kept_ = Clock::now();
        keeping_ = secondsSince(start);
    }
    /// Writes the statistics. Errors: Error where frames failed.
    void finish(std::size_t frames) const {
        writeStatistics(options_.stats, "{\"frames\": [" + statistics_ + "]}\n");
        if (!failed_.empty())
            throw Error(fmt::format("{} of {} frames failed", failed_.size(), frames),
                        "frames " + job::inWords(failed_), "see the warnings; --skip-existing renders these alone");
    }

  private:
    scene::Scene sceneOf(const Frame& frame) { return placeClouds(scenes_.at(frame.frame), &places_); }
    /// The scene of the frame behind, where there is one; what is wrong with it shows when it is rendered.
    std::optional<scene::Scene> readable(const Frame* next) {
        if (next == nullptr) return std::nullopt;
        try {
            return sceneOf(*next);
        } catch (const Error&) {
            return std::nullopt;
        }
    }
    std::filesystem::path keptMap(std::span<const Frame> frames) const {
        return namesOf(options_, frames.front().frame).front().replace_extension(".map");
    }
    void attempt(const Frame& frame, const auto& work) {
        try {
            work();
        } catch (const std::exception& e) {
            stopIfInterrupted();
            renderer_.forget();
            logWarning(fmt::format("frame {}: {}", frame.frame, e.what()));
            failed_.push_back(frame.frame);
        }
    }
    RendererOptions rendererOptions() {
        RendererOptions how;
        how.device = options_.device;
        how.validation = options_.validate;
        how.loaded = [this](std::span<const CloudSummary> clouds, std::span<const std::string>) {
            tellClouds(clouds, {}, options_.quiet || std::exchange(told_, true));
        };
        return how;
    }
    static double secondsSince(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    void note(std::int64_t frame, const Statistics& statistics, double writing, double whole,
              const ErrorOfPicture& error) {
        if (warned_ != statistics.warnings)
            for (const std::string& warning : statistics.warnings) logWarning(warning);
        warned_ = statistics.warnings;
        if (options_.stats.empty()) return;
        if (!statistics_.empty()) statistics_ += ", ";
        statistics_ += fmt::format("{{\"frame\": {}, \"statistics\": {}}}", frame,
                                   statisticsJson(statistics, std::nullopt, writing, whole, &error));
    }

    const RenderOptions& options_;
    const FrameScenes& scenes_;
    KnownPlaces places_;
    Steps steps_{true};
    bool told_ = false;  ///< of the clouds of the first frame
    job::FrameRenderer renderer_;
    Clock::time_point kept_ = Clock::now();
    double keeping_ = 0.0;  ///< seconds that it took to keep the light
    std::vector<std::int64_t> failed_;
    std::vector<std::string> warned_;
    std::string statistics_;
};

/// Renders the frames whose files are not there, each for itself.
void renderEach(Frames& work, const std::vector<Frame>& frames, bool quiet) {
    std::vector<Frame> missing = frames;
    std::erase_if(missing, [](const Frame& frame) { return frame.isThere; });
    Progress progress("frames", std::max<std::size_t>(1, missing.size()), quiet || missing.empty());
    for (std::size_t i = 0; i < missing.size(); ++i) {
        stopIfInterrupted();
        work.render(missing[i], i + 1 < missing.size() ? &missing[i + 1] : nullptr);
        progress.advance();
    }
}

/// Renders frames that go on with the light of those before them: also those are traced, from the one on whose light
/// was kept.
void renderChain(Frames& work, const std::vector<Frame>& frames, bool quiet) {
    const auto missing = std::ranges::find(frames, false, &Frame::isThere);
    if (missing == frames.end()) return;
    const auto first = static_cast<std::size_t>(work.resume(frames, missing->number));
    const auto last = std::ranges::find(frames.rbegin(), frames.rend(), false, &Frame::isThere)->number;
    Progress progress("frames", static_cast<std::size_t>(last) + 1 - first, quiet);
    for (std::size_t i = first; i <= static_cast<std::size_t>(last); ++i) {
        stopIfInterrupted();
        const Frame* const next = i < static_cast<std::size_t>(last) ? &frames[i + 1] : nullptr;
        frames[i].isThere ? work.trace(frames[i], next) : work.render(frames[i], next);
        work.keepLight(frames, next == nullptr);
        progress.advance();
    }
}

/// Reads the scene of each frame, so that what is wrong with one shows before the work. Returns whether light goes from
/// frame to frame.
bool checkScenes(const FrameScenes& scenes, const std::vector<std::int64_t>& frames) {
    bool transfer = false;
    for (const std::int64_t frame : frames) {
        stopIfInterrupted();
        const scene::Scene scene = scenes.at(frame);
        if (frame != frames.front() && scene.photonMap.transfer != transfer)
            throw InputError("whether light goes from frame to frame cannot change between them",
                             "animate.photon_map.transfer", "write photon_map.transfer once");
        transfer = scene.photonMap.transfer;
    }
    return transfer;
}

}  // namespace

void runFrames(const RenderOptions& options) {
    const std::vector<std::int64_t> asked = job::parseFrames(options.frames).numbers();
    checkOptions(options, asked.front());
    const FrameScenes scenes(options);
    const bool transfer = checkScenes(scenes, asked);
    const std::vector<Frame> frames = framesOf(options, asked);
    const auto there = std::ranges::count(frames, true, &Frame::isThere);
    if (there > 0 && !options.quiet) logNote(fmt::format("{} of {} frames are there", there, asked.size()));
    Frames work(options, scenes);
    transfer ? renderChain(work, frames, options.quiet) : renderEach(work, frames, options.quiet);
    work.finish(asked.size());
}

}  // namespace lumulus::cli
