#include "cli/options.h"

#include <map>

namespace lumulus::cli {

CLI::Validator notEmpty() {
    return {[](const std::string& text) { return text.empty() ? "give it a value" : ""; }, "TEXT"};
}

CLI::Range seedRange() {
    return {std::uint64_t{0}, std::uint64_t{1} << 53};
}

CLI::Option* addDevice(CLI::App& command, std::string& device) {
    return command.add_option("--device", device, "Name (a part is enough) or index of a device, see info --devices")
        ->check(notEmpty());
}

void addOverrides(CLI::App& command, std::vector<std::string>& overrides) {
    command.add_option("--set", overrides, "Override section.key=value of the scene; may repeat")
        ->allow_extra_args(false);
}

void addFrame(CLI::App& command, std::optional<std::int64_t>& frame) {
    command.add_option("--frame", frame, "Frame of an animated scene, as of render --frames (default: 0)")
        ->check(CLI::Range(std::int64_t{0}, std::int64_t{999'999'999}));
}

void addQuality(CLI::App& command, std::optional<scene::Quality>& quality) {
    const std::map<std::string, scene::Quality> qualities{{"draft", scene::Quality::draft},
                                                          {"interactive", scene::Quality::interactive},
                                                          {"final", scene::Quality::final}};
    command
        .add_option_function<std::string>(
            "--quality", [&quality, qualities](const std::string& name) { quality = qualities.at(name); },
            "Preset for keys that the scene leaves out: draft, interactive or final")
        ->check(CLI::IsMember({"draft", "interactive", "final"}));
}

}  // namespace lumulus::cli
