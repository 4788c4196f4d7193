#include "cli/manual.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/version.h"
#include "cli/advice.h"

namespace lumulus::cli {
namespace {

/// Text as roff shows it: "-" stays the one of the keyboard, and no line is taken for a request.
std::string roff(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
        if (c == '-' || c == '\\') result += c == '-' ? "\\" : "\\e";
        if (c != '\\') result += c;
    }
    return result;
}

std::string head(std::string_view name, std::string_view description) {
    std::string title(name);
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return fmt::format(".TH {} 1 \"\" \"lumulus {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", title, roff(version),
                       roff(name), roff(description));
}

/// What stands behind an option in the help: "TEXT", "FLOAT in [0 - 1]", "TEXT:{a,b}", and its default.
std::string valueOf(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return {};
    std::string text = option.get_type_name();
    if (!option.get_default_str().empty()) text += "=" + option.get_default_str();
    return text.empty() ? text : " \\fI" + roff(text) + "\\fR";
}

std::string namesOf(const CLI::Option& option) {
    if (option.get_positional()) return "\\fI" + roff(option.get_single_name()) + "\\fR";
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("\\fB" + roff("-" + name) + "\\fR");
    for (const std::string& name : option.get_lnames()) names.push_back("\\fB" + roff("--" + name) + "\\fR");
    return fmt::format("{}", fmt::join(names, ", ")) + valueOf(option);
}

/// The section of the positional arguments, or of the options; empty if there are none.
std::string section(std::string_view title, const CLI::App& command, bool positional) {
    std::string text;
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_positional() != positional) continue;
        text += ".TP\n" + namesOf(*option) + "\n" + roff(option->get_description()) +
                (option->get_required() ? " (required)" : "") + "\n";
    }
    return text.empty() ? text : fmt::format(".SH {}\n{}", title, text);
}

std::string synopsis(const CLI::App& command) {
    std::string text = fmt::format(".SH SYNOPSIS\n.B lumulus {}\n[OPTIONS]", roff(command.get_name()));
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_positional()) continue;
        const std::string name = roff(option->get_single_name());
        text += option->get_required() ? " \\fI" + name + "\\fR" : " [\\fI" + name + "\\fR]";
    }
    return text + "\n";
}

/// The footer of a command is "Example:" and lines of commands.
std::string example(const CLI::App& command) {
    std::istringstream lines(command.get_footer());
    std::string text, line;
    while (std::getline(lines, line))
        if (line.starts_with("  ")) text += roff(line.substr(2)) + "\n";
    return text.empty() ? text : ".SH EXAMPLE\n.nf\n" + text + ".fi\n";
}

}  // namespace

std::string programManual(const CLI::App& app) {
    std::string text = head("lumulus", "render clouds, fog and skies");
    text += ".SH SYNOPSIS\n.B lumulus\n[OPTIONS] COMMAND\n";
    text += ".SH DESCRIPTION\n" + roff(app.get_description()) + "\n";
    text += ".SH COMMANDS\n";
    for (const std::string& name : commandNames(app))
        text += fmt::format(".TP\n\\fB{}\\fR\n{} See \\fBlumulus\\-{}\\fR(1).\n", roff(name),
                            roff(commandOf(app, name).get_description() + "."), roff(name));
    text += section("OPTIONS", app, false);
    text +=
        ".SH EXIT STATUS\n.TP\n0\nThe work is done.\n.TP\n1\nIt failed while running.\n.TP\n2\nBad usage or bad "
        "input.\n";
    return text;
}

std::string commandManual(const CLI::App& app, const CLI::App& command) {
    std::string text = head("lumulus-" + command.get_name(), command.get_description());
    text += synopsis(command) + section("ARGUMENTS", command, true) + section("OPTIONS", command, false);
    text += example(command);
    std::vector<std::string> others{"\\fBlumulus\\fR(1)"};
    for (const std::string& name : commandNames(app))
        if (name != command.get_name()) others.push_back(fmt::format("\\fBlumulus\\-{}\\fR(1)", roff(name)));
    return text + fmt::format(".SH SEE ALSO\n{}\n", fmt::join(others, ",\n"));
}

}  // namespace lumulus::cli
