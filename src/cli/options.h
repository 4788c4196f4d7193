#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/bake.h"
#include "cli/environment.h"
#include "cli/light_maps.h"
#include "cli/render.h"
#include "scene/quality.h"

/// Options that several commands have, and the commands that have an own file for theirs.
namespace lumulus::cli {

/// Runs the subcommand of the command line; empty until the command line is parsed.
using Action = std::function<void()>;

inline constexpr const char* sceneHelp = "Scene file (TOML), an OpenVDB or NanoVDB file, or - for standard input";

/// Refuses empty text, which usually comes from an unset shell variable and is no wish for the default.
CLI::Validator notEmpty();

/// The range of seeds, 0 to 2^53 as in scene files.
CLI::Range seedRange();

CLI::Option* addDevice(CLI::App& command, std::string& device);
void addQuality(CLI::App& command, std::optional<scene::Quality>& quality);
void addOverrides(CLI::App& command, std::vector<std::string>& overrides);
/// --frame: the frame at which the scene is.
void addFrame(CLI::App& command, std::optional<std::int64_t>& frame);

void addRender(CLI::App& app, RenderOptions& options, Action& action);
void addMerge(CLI::App& app, MergeOptions& options, Action& action);
void addBake(CLI::App& app, BakeOptions& options, Action& action);
void addEnvironment(CLI::App& app, EnvironmentOptions& options, Action& action);

}  // namespace lumulus::cli
