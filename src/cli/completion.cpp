#include "cli/completion.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string_view>
#include <vector>

#include "cli/advice.h"

namespace lumulus::cli {
namespace {

std::vector<std::string> namesOf(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

/// The words that an option takes ("TEXT:{draft,final}"), with blanks between them; empty if it takes any.
std::string wordsOf(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t open = type.find('{'), close = type.rfind('}');
    if (open == std::string::npos || close == std::string::npos || close < open) return {};
    std::string words = type.substr(open + 1, close - open - 1);
    for (char& c : words)
        if (c == ',') c = ' ';
    return words;
}

/// The function's branches for one command: after an option what it takes, else options where a "-" stands.
std::string branches(const CLI::App& command) {
    std::vector<std::string> all;
    std::string text;
    for (const CLI::Option* option : command.get_options()) {
        const std::vector<std::string> names = namesOf(*option);
        all.insert(all.end(), names.begin(), names.end());
        if (names.empty() || option->get_items_expected_max() == 0) continue;
        const std::string words = wordsOf(*option);
        text += fmt::format("        {}:{}) values=\"{}\" ;;\n", command.get_name(),
                            fmt::join(names, "|" + command.get_name() + ":"), words.empty() ? "FILE" : words);
    }
    return text + fmt::format("        {}:*) options=\"{}\" ;;\n", command.get_name(), fmt::join(all, " "));
}

constexpr std::string_view script = R"(# Completion of bash for lumulus, made from its help: lumulus help --files FOLDER
_lumulus()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command= values= options= word
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        case " @COMMANDS@ " in *" $word "*) command=$word; break ;; esac
    done
    COMPREPLY=()
    case "$command:$previous" in
@BRANCHES@    esac
    if [[ $values == FILE ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    elif [[ -n $values ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
    elif [[ -z $command ]]; then
        mapfile -t COMPREPLY < <(compgen -W "@COMMANDS@ $options" -- "$current")
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
    elif [[ $command == help ]]; then
        mapfile -t COMPREPLY < <(compgen -W "@COMMANDS@" -- "$current")
    else
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}
complete -F _lumulus lumulus
)";

std::string replaced(std::string text, std::string_view mark, const std::string& by) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + by.size()))
        text.replace(at, mark.size(), by);
    return text;
}

}  // namespace

std::string bashCompletion(const CLI::App& app) {
    const std::vector<std::string> names = commandNames(app);
    std::string all;
    for (const std::string& name : names) all += branches(commandOf(app, name));
    // the program's own options stand before a command, whose name is empty then
    const std::string program = app.get_name();
    all += replaced(replaced(branches(app), program + ":*", ":*"), program + ":-", ":-");
    return replaced(replaced(std::string(script), "@BRANCHES@", all), "@COMMANDS@",
                    fmt::format("{}", fmt::join(names, " ")));
}

}  // namespace lumulus::cli
