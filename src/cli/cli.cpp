#include "cli/cli.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <new>
#include <span>

#include "base/error.h"
#include "base/log.h"
#include "base/version.h"
#include "cli/advice.h"
#include "cli/bake.h"
#include "cli/bench.h"
#include "cli/cloud.h"
#include "cli/compare.h"
#include "cli/composite.h"
#include "cli/fetch.h"
#include "cli/help.h"
#include "cli/info.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/query.h"
#include "cli/reference.h"
#include "cli/render.h"
#include "cli/serve.h"
#include "cli/sky.h"
#include "cli/slab.h"
#include "cli/threads.h"

namespace lumulus::cli {
namespace {

void addCloud(CLI::App& app, CloudOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("cloud", "Make a procedural cloud as an OpenVDB file");
    command->add_option("kind", options.kind, "cumulus, stratocumulus, stratus, cirrus, sphere or slab")->required();
    command->add_option("-o,--output", options.output, "OpenVDB file (.vdb)")->required();
    command->add_option("--resolution", options.resolution, "Voxels along the longest side")->capture_default_str();
    command->add_option("--seed", options.seed, "Seed of the shape")->check(seedRange())->capture_default_str();
    command
        ->add_option("--frames", options.frames,
                     "Files of a cloud that moves, FIRST-LAST or FIRST-LAST:STEP, each with its velocities")
        ->check(notEmpty());
    command->add_option("--fps", options.fps, "Frames a second")->check(CLI::Range(1e-3, 1e4))->capture_default_str();
    command->add_option("--wind", options.wind, "With --frames: velocity of all of it, X,Y,Z, m/s")
        ->delimiter(',')
        ->expected(3)
        ->check(CLI::Range(-1e4, 1e4));
    command->add_option("--swirl", options.swirl, "With --frames: speed with which it deforms, m/s")
        ->check(CLI::Range(0.0, 1e3))
        ->capture_default_str();
    command->add_flag("--quiet", options.quiet, "No progress");
    command->footer(
        "Example:\n  lumulus cloud cumulus -o cumulus.vdb --resolution 256 --seed 7\n"
        "  lumulus cloud cumulus -o moving_####.vdb --frames 0-23 --fps 1 --wind 10,0,0 --swirl 4");
    command->callback([&options, &action] { action = [&options] { runCloud(options); }; });
}

void addInfo(CLI::App& app, InfoOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("info", "Show the grids of an OpenVDB or NanoVDB file, or the devices");
    command->add_option("file", options.file, "OpenVDB or NanoVDB file");
    command->add_flag("--devices", options.devices, "List the Vulkan devices");
    command->add_flag("--scene-format", options.sceneFormat, "Show all keys of scene files, as Markdown");
    command->add_flag("--json", options.json, "As JSON");
    command->footer("Example:\n  lumulus info cloud.vdb\n  lumulus info --devices --json");
    command->callback([&options, &action] { action = [&options] { runInfo(options); }; });
}

void addQuery(CLI::App& app, QueryOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("query", "Ask what a scene does to light, without a picture");
    command->add_option("scene", options.scene, sceneHelp)->required();
    command
        ->add_option("--segments", options.segments, "Transmittance between points (.csv: x0,y0,z0,x1,y1,z1, metres)")
        ->check(notEmpty());
    command->add_option("--sun", options.sun, "Transmittance from points to the sun (.csv: x,y,z, metres)")
        ->check(notEmpty());
    command->add_option("--ambient", options.ambient, "Light from all around points (.csv: x,y,z, metres)")
        ->check(notEmpty());
    command
        ->add_option("--ground-shadow", options.rectangle,
                     "Transmittance of the sun over a level rectangle: X0,Z0,X1,Z1, metres")
        ->delimiter(',')
        ->expected(4);
    command->add_option("--size", options.size, "Pixels of the rectangle, WIDTHxHEIGHT")->capture_default_str();
    command->add_option("--height", options.height, "Height of the rectangle, metres (default: the ground's)");
    command->add_option("-o,--output", options.output, "Table, or picture (.exr) of a rectangle; default: stdout");
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    addQuality(*command, options.quality);
    addDevice(*command, options.device);
    command->add_flag("--json", options.json, "As JSON");
    command->add_flag("--quiet", options.quiet, "No progress");
    command->footer(
        "Example:\n  lumulus query configs/scenes/cumulus.toml --ground-shadow -2e3,-2e3,2e3,2e3 -o shadow.exr");
    command->callback([&options, &action] { action = [&options] { runQuery(options); }; });
}

void addReference(CLI::App& app, ReferenceOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("reference", "Render a scene without bias, by path tracing on the CPU");
    command->add_option("scene", options.scene, sceneHelp)->required();
    command
        ->add_option("-o,--output", options.output,
                     "Picture (.exr); a file .sums beside it holds the exact sums; with --frame, "
                     "#### or %04d is its number")
        ->required();
    const CLI::Range positive(1e-3, 1e9);
    command->add_option("--spp", options.spp, "Stop at this many samples per pixel")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
    command->add_option("--seconds", options.seconds, "Stop after this time")->check(positive);
    command
        ->add_option_function<std::string>(
            "--majorant", [&options](const std::string& name) { options.localMajorant = name == "local"; },
            "global (default) or local, which is faster and changes only the noise")
        ->check(CLI::IsMember({"global", "local"}));
    command
        ->add_option("--scatterings", options.scatterings,
                     "Leave out light that was scattered or reflected more often; 1 is single scattering")
        ->check(CLI::Range(0, 1'000'000));
    command->add_flag("--resume", options.resume, "Continue the existing file; --spp includes its samples");
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    command->add_option("--seed", options.seed, "Seed of the random numbers (photon_map.seed)")->check(seedRange());
    command->add_option("--stats", options.stats, "Write statistics as JSON to this file, - for standard output")
        ->check(notEmpty());
    command->add_flag("--quiet", options.quiet, "No progress");
    command->footer(
        "Example:\n  lumulus reference configs/scenes/cumulus.toml -o truth.exr --spp 256 --majorant local");
    command->callback([&options, &action] { action = [&options] { runReference(options); }; });
}

void addCompare(CLI::App& app, CompareOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("compare", "Measure how far a picture is from a reference");
    command->add_option("image", options.image, "Picture (.exr)")->required();
    command->add_option("reference", options.reference, "Reference (.exr)");
    command->add_option("second", options.secondReference,
                        "A second, independent reference, which removes the noise of both");
    command
        ->add_option("--denominator", options.denominator,
                     "Picture (.exr) whose squares divide those of errors in relMSE, and whose cloud is compared, for "
                     "references of few samples; default: the reference")
        ->check(notEmpty());
    command->add_flag("--self", options.self,
                      "Without a reference: print what `render --error` has noted in the picture of its own error");
    command->add_flag("--json", options.json, "As JSON");
    command->add_option("--diff", options.diff,
                        "Write the difference: false colours (.png) or image - reference (.exr)");
    command
        ->add_option("--exposure", options.exposure,
                     "Photographic stops for the tone-mapped pictures that FLIP compares")
        ->check(CLI::Range(-32.0, 32.0));
    command->footer("Example:\n  lumulus compare cumulus.exr truth.exr --diff difference.png");
    command->callback([&options, &action] { action = [&options] { runCompare(options); }; });
}

void addComposite(CLI::App& app, CompositeOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("composite", "Show a picture of any renderer through a scene's fog");
    command->add_option("--color", options.color, "Picture (.exr) with R, G and B, linear")->required();
    command->add_option(
        "--depth", options.depth,
        "File (.exr) with Z or depth.Z, in any part or layer; default: the picture itself. See fog.depth for "
        "its meaning");
    command
        ->add_option("--layer", options.layer,
                     "Layer or part of the colour, such as ViewLayer.Combined; default: R, G, B, or the only layer")
        ->check(notEmpty());
    command->add_option("--scene", options.scene, "Scene file (TOML): its camera and its fog")->required();
    command->add_option("-o,--output", options.outputs, "Picture: .exr (linear float) or .png; may repeat")
        ->required()
        ->allow_extra_args(false);
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    addDevice(*command, options.device);
    command->add_option("--stats", options.stats, "Write statistics as JSON to this file, - for standard output")
        ->check(notEmpty());
    command->add_flag("--validate", options.validate, "Run with Vulkan validation; fail on any message");
    command->footer("Example:\n  lumulus composite --color view.exr --scene fog.toml -o fog.exr -o fog.png");
    command->callback([&options, &action] { action = [&options] { runComposite(options); }; });
}

void addSlab(CLI::App& app, SlabOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("slab", "Trace a plane-parallel layer: reflected, transmitted, absorbed");
    command->add_option("--tau", options.slab.tau, "Optical thickness")->required();
    command->add_option("--g", options.slab.phase.g, "Asymmetry of Henyey-Greenstein, -1 < g < 1")->required();
    command->add_option("--albedo", options.slab.albedo, "Single-scattering albedo")->required();
    command->add_option("--mu0", options.slab.mu0, "Cosine of the angle of incidence")->required();
    command->add_option("--photons", options.slab.photons, "Photons to trace")->capture_default_str();
    command->add_option("--seed", options.slab.seed, "Seed of the random numbers")->check(seedRange());
    CLI::Option* device = addDevice(*command, options.device);
    command
        ->add_flag("--reference", options.reference, "Trace with the path tracer of `reference` on the CPU, as a check")
        ->excludes(device);
    command->add_flag("--json", options.json, "As JSON");
    command->footer("Example:\n  lumulus slab --tau 2 --g 0.75 --albedo 0.9 --mu0 1 --json");
    command->callback([&options, &action] { action = [&options] { runSlab(options); }; });
}

void addSky(CLI::App& app, SkyOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("sky", "Show where sun and moon stand and the light of a scene's sky");
    command->add_option("scene", options.scene, "Scene file (TOML) or - for standard input; default: an empty scene");
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    command->add_flag("--json", options.json, "As JSON");
    command->footer(
        "Example:\n  lumulus sky --set sky.model=atmosphere --set time.utc=2026-06-21T10:00:00Z --set "
        "time.latitude=50.1 "
        "--set time.longitude=14.4");
    command->callback([&options, &action] { action = [&options] { runSky(options); }; });
}

void addBench(CLI::App& app, BenchOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("bench", "Measure error against run time of render and of the path tracer");
    command->add_option("scene", options.scene, sceneHelp)->required();
    command->add_option("--reference", options.reference, "Reference (.exr), of the scene's size")->required();
    command->add_option("-o,--output", options.output, "Folder for error.csv, error.svg and error.png")->required();
    command->add_option("--seconds", options.seconds, "Budgets in seconds without warm-up (default: 0.1,0.3,1,3,10)")
        ->delimiter(',');
    command->add_option("--seeds", options.seeds, "Pictures for each budget")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--cycles", options.cycles, "Points of Blender's Cycles, from scripts/study/run cycles (.csv)")
        ->check(notEmpty());
    addOverrides(*command, options.overrides);
    addFrame(*command, options.frame);
    addDevice(*command, options.device);
    command->add_flag("--quiet", options.quiet, "No progress");
    command->footer("Example:\n  lumulus bench configs/scenes/cumulus.toml --reference truth.exr -o bench");
    command->callback([&options, &action] { action = [&options] { runBench(options); }; });
}

void addServe(CLI::App& app, ServeOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("serve", "Serve frames to simulators, scripts and browsers");
    command->add_option("--config", options.config, "Configuration (TOML); docs/service.md explains it")->required();
    command->footer("Example:\n  lumulus serve --config configs/service.toml");
    command->callback([&options, &action] { action = [&options] { runServe(options); }; });
}

void addFetch(CLI::App& app, FetchOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("fetch", "Get one frame of a running service as a picture");
    command->add_option("-o,--output", options.output, "Picture: .exr (all layers), .png or .jpg")->required();
    command->add_option("--address", options.address, "HOST:PORT or unix:PATH")->capture_default_str();
    command->add_option("--token-file", options.tokenFile, "File with the server's token");
    command->add_option("--scene", options.scene, "Name of a scene on the server, or a local scene file (.toml)");
    command->add_option("--vdb", options.vdb, "OpenVDB file to upload instead of the scene's cloud");
    addOverrides(*command, options.overrides);
    command->add_option("--quality", options.quality, "Preset, as for render: draft, interactive or final")
        ->check(CLI::IsMember({"draft", "interactive", "final"}));
    command->add_option("--width", options.width, "Pixels");
    command->add_option("--height", options.height, "Pixels");
    command->add_option("--position", options.position, "Position of the camera: X Y Z, metres")->expected(3);
    command->add_option("--target", options.target, "Point that the camera looks at: X Y Z, metres")->expected(3);
    command->add_option("--fov", options.verticalFov, "Vertical field of view, degrees");
    command->add_option("--sun", options.sun, "Direction of the sun: AZIMUTH ELEVATION, degrees")->expected(2);
    CLI::Option* deadline =
        command->add_option("--milliseconds", options.milliseconds, "Deadline; the server does less work to keep it");
    command
        ->add_option("--photons", options.photons, "Draw when this many photons are traced (default: all of the scene)")
        ->excludes(deadline);
    command->add_option("--exposure", options.exposure, "Photographic stops, for .png and .jpg");
    command
        ->add_option("--stats", options.stats, "Write the server's reply as JSON to this file, - for standard output")
        ->check(notEmpty());
    command->add_option("--timeout", options.timeout, "Longest wait for each step, seconds")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str();
    command->footer("Example:\n  lumulus fetch -o cloud.png --width 640 --height 360 --sun 120 20");
    command->callback([&options, &action] { action = [&options] { runFetch(options); }; });
}

void addHelp(CLI::App& app, HelpOptions& options, Action& action) {
    CLI::App* command = app.add_subcommand("help", "Show the help of the program or of a command");
    command->add_option("command", options.command, "Command to explain");
    command
        ->add_option("--files", options.files, "Write man pages and the completion of bash below this folder instead")
        ->check(notEmpty());
    command->footer("Example:\n  lumulus help render");
    command->callback([&app, &options, &action] { action = [&app, &options] { runHelp(app, options); }; });
}

/// --threads, before the command or behind it.
void addThreads(CLI::App& app, std::optional<int>& threads) {
    std::vector<CLI::App*> all = app.get_subcommands([](const CLI::App*) { return true; });
    all.push_back(&app);
    for (CLI::App* command : all)
        command->add_option("--threads", threads, "Use at most this many threads of the CPU (default: one a core)")
            ->check(CLI::Range(1, 1024));
}

ThreadUse useOf(const std::string& command, const InfoOptions& info, const SlabOptions& slab,
                const QueryOptions& query) {
    if (command == "serve") return ThreadUse::server;
    const bool device = command == "render" || command == "bake" || command == "environment" ||
                        command == "composite" || command == "bench" || (command == "slab" && !slab.reference) ||
                        (command == "info" && info.devices) || (command == "query" && !query.ambient.empty());
    return device ? ThreadUse::device : ThreadUse::host;
}

/// Parses the command line and runs the command. Errors of CLI11 become bad usage; help and version do not fail.
void parseAndRun(int argc, const char* const* argv) {
    CLI::App app("Lumulus renders clouds.", "lumulus");
    app.set_version_flag("--version", std::string("lumulus ") + version);
    app.footer("Each command has its own help: lumulus help render");
    app.require_subcommand(1);
    Action action;
    RenderOptions render;
    MergeOptions merge;
    BakeOptions bake;
    EnvironmentOptions environment;
    CloudOptions cloud;
    InfoOptions info;
    QueryOptions query;
    ReferenceOptions reference;
    CompareOptions compare;
    CompositeOptions composite;
    BenchOptions bench;
    SkyOptions sky;
    SlabOptions slab;
    ServeOptions serve;
    FetchOptions fetch;
    HelpOptions help;
    std::optional<int> threads;
    addRender(app, render, action);
    addMerge(app, merge, action);
    addBake(app, bake, action);
    addEnvironment(app, environment, action);
    addCloud(app, cloud, action);
    addInfo(app, info, action);
    addQuery(app, query, action);
    addReference(app, reference, action);
    addCompare(app, compare, action);
    addComposite(app, composite, action);
    addBench(app, bench, action);
    addSky(app, sky, action);
    addSlab(app, slab, action);
    addServe(app, serve, action);
    addFetch(app, fetch, action);
    addHelp(app, help, action);
    addThreads(app, threads);
    refuseUnknownWords(app, std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0));
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success&) {
        printOut(app.count("--version") > 0 ? app.version() + "\n" : app.help());
        return;
    } catch (const CLI::ParseError& e) {
        const auto chosen = app.get_subcommands();
        const std::string name = chosen.empty() ? "lumulus" : "lumulus " + chosen.front()->get_name();
        throw InputError(e.what(), "command line", "see " + name + " --help");
    }
    limitThreads(threads, useOf(app.get_subcommands().front()->get_name(), info, slab, query));
    action();
}

}  // namespace

int run(int argc, const char* const* argv) {
    try {
        parseAndRun(argc, argv);
        return 0;
    } catch (const Error& e) {
        logError(e.what());
        return e.exitCode();
    } catch (const std::bad_alloc&) {
        logError("out of memory: make the picture or the cloud smaller");
    } catch (const std::exception& e) {
        logError(unforeseen(e));
    }
    return 1;
}

}  // namespace lumulus::cli
