// The options of `lumulus render` and of `lumulus merge`.
#include "cli/options.h"

namespace lumulus::cli {

namespace {

void addErrorOptions(CLI::App& command, ErrorOptions& options) {
    command.add_flag("--error", options.wanted,
                     "Measure bias and relMSE of the picture by unbiased paths, for as long as the picture took: in "
                     "--stats, in the header and as layers of .exr");
    command
        .add_option("--error-seconds", options.seconds,
                    "Measure the error for at most this many seconds, instead of the time that the picture took")
        ->check(notEmpty());
    command
        .add_option("--error-paths", options.paths,
                    "Measure the error by this many paths at least, whatever time they take: its bits repeat")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40U));
    command.add_flag(
        "--correct", options.correct,
        "Correct the picture by unbiased paths, so that its mean has no bias, and measure the error that is "
        "left");
    command.add_flag("--no-correct", options.uncorrected,
                     "Do not correct pictures of clouds whose light photons alone make wrong");
}

}  // namespace

void addRender(CLI::App& app, RenderOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("render", "Render a scene to pictures");
    command->add_option("scene", options.scene, sceneHelp)->required();
    command->add_option("-o,--output", options.outputs, "Picture: .exr (linear float layers) or .png; may repeat")
        ->allow_extra_args(false);
    addQuality(*command, options.quality);
    addOverrides(*command, options.overrides);
    command
        ->add_option("--frames", options.frames,
                     "Frames of a sequence, FIRST-LAST or FIRST-LAST:STEP: outputs have #### or %04d in their names")
        ->check(notEmpty());
    command->add_flag("--skip-existing", options.skipExisting, "Leave out frames whose files are there and whole");
    command->add_option("--map-out", options.maps.out, "Write the photon map to this file")->check(notEmpty());
    command->add_option("--map-in", options.maps.in,
                        "Begin with the photons of these maps of the same scene; what is missing is traced");
    command
        ->add_option(
            "--generations", options.maps.generations,
            "The part of the scene's generations of photons that this run traces: FIRST-LAST, counted from 0, or "
            "PART/PARTS, such as 1/4")
        ->check(notEmpty());
    command->add_option("--seed", options.seed, "Seed of the random numbers (photon_map.seed)")->check(seedRange());
    command
        ->add_option("--seconds", options.seconds,
                     "Trace photons so that the whole run, with drawing and writing, takes this many seconds")
        ->check(notEmpty());
    command
        ->add_option("--target-error", options.targetError,
                     "Trace photons until the estimated relMSE of their noise is this small")
        ->check(notEmpty());
    addErrorOptions(*command, options.error);
    addDevice(*command, options.device);
    command->add_option("--stats", options.stats, "Write statistics as JSON to this file, - for standard output")
        ->check(notEmpty());
    command->add_flag("--quiet", options.quiet, "Show no progress");
    command->add_flag("--validate", options.validate, "Run with Vulkan validation; fail on any message");
    command->footer(
        "Example:\n  lumulus render configs/scenes/cumulus.toml -o cumulus.exr -o cumulus.png --quality draft");
    command->callback([&options, &action] { action = [&options] { runRender(options); }; });
}

void addMerge(CLI::App& app, MergeOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("merge", "Add up photon maps exactly, in any order");
    command->add_option("maps", options.maps, "Maps that `lumulus render --map-out` has written for one scene")
        ->required();
    command->add_option("-o,--output", options.output, "Photon map of them all")->required();
    command->add_flag("--quiet", options.quiet, "Say nothing");
    command->footer(
        "Example:\n  lumulus render cloud.toml --generations 0-9 --map-out a.map\n"
        "  lumulus render cloud.toml --generations 10-19 --map-out b.map\n"
        "  lumulus merge a.map b.map -o all.map\n  lumulus render cloud.toml --map-in all.map -o cloud.exr");
    command->callback([&options, &action] { action = [&options] { runMerge(options); }; });
}

}  // namespace lumulus::cli
