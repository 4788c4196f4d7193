#include "cli/advice.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <initializer_list>

#include "base/error.h"
#include "scene/suggest.h"

namespace lumulus::cli {
namespace {

/// The option in a word of the command line ("--quality=draft", "-oa.png"), or nothing if it is a value. A number with
/// a sign is a value.
std::string optionIn(std::string_view word) {
    if (word.starts_with("--") && word.size() > 2) return std::string(word.substr(0, word.find('=')));
    const bool shortOption = word.size() > 1 && word[0] == '-' && word[1] != '-' && word[1] != ' ';
    const bool number = shortOption && ((word[1] >= '0' && word[1] <= '9') || word[1] == '.');
    return shortOption && !number ? std::string(word.substr(0, 2)) : std::string();
}

bool takesOption(const CLI::App& command, const std::string& name) {
    return command.get_option_no_throw(name) != nullptr;
}

/// A word that begins with a dash of typography, as text processors and web pages put in the place of "--": the option
/// that is meant, or empty.
std::string typesetOption(std::string_view word) {
    const auto takeDash = [&word](std::initializer_list<std::string_view> dashes) {
        for (const std::string_view dash : dashes) {
            if (!word.starts_with(dash)) continue;
            word.remove_prefix(dash.size());
            return true;
        }
        return false;
    };
    if (!takeDash({"\u2013", "\u2014", "\u2212"})) return {};
    while (takeDash({"\u2013", "\u2014", "\u2212", "-"})) continue;
    if (word.empty()) return {};
    return (word.size() == 1 ? "-" : "--") + std::string(word);
}

/// All names of options that the help of a command shows.
std::vector<std::string> optionNames(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

const CLI::App* findCommand(const CLI::App& app, std::string_view name) {
    const auto all = commandsOf(app);
    const auto it = std::ranges::find(all, name, [](const CLI::App* command) { return command->get_name(); });
    return it == all.end() ? nullptr : *it;
}

std::string titleOf(const CLI::App& app, const CLI::App& command) {
    return &app == &command ? "lumulus" : "lumulus " + command.get_name();
}

/// What to write instead of an option that the command does not have. `rest` are the words behind it.
std::string optionAdvice(const CLI::App& app, const CLI::App& command, const std::string& word,
                         std::span<const char* const> rest) {
    const std::string name = optionIn(word), whole = word.substr(0, word.find('='));
    if (&command == &app) {  // an option of a command that stands before it
        for (const char* next : rest) {
            const CLI::App* later = findCommand(app, next);
            if (later != nullptr && takesOption(*later, name))
                return fmt::format("write it behind the command: lumulus {} {}", later->get_name(), name);
        }
    }
    const std::vector<std::string> known = optionNames(command);
    std::string near = nearestWord(whole, known);
    if (near.empty() && !whole.starts_with("--")) near = nearestWord("-" + whole, known);  // -quality
    if (!near.empty()) return fmt::format("did you mean {}?", near);
    for (const CLI::App* other : commandsOf(app))
        if (takesOption(*other, whole)) return fmt::format("{} has such an option", titleOf(app, *other));
    return fmt::format("see {} --help", titleOf(app, command));
}

}  // namespace

std::string nearestWord(std::string_view word, std::span<const std::string> known) {
    // a longer word is no spelling mistake, and would cost time and memory
    if (word.size() > 64) return {};
    const std::size_t letters = word.size() - std::min(word.size(), word.find_first_not_of('-'));
    std::size_t best = 1 + letters / 3;
    std::string nearest;
    for (const std::string& one : known) {
        const std::size_t distance = scene::editDistance(word, one);
        if (distance >= letters || distance > best || (distance == best && !nearest.empty())) continue;
        best = distance;
        nearest = one;
    }
    return nearest;
}

std::vector<std::string> commandNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : commandsOf(app)) names.push_back(command->get_name());
    return names;
}

void unknownCommand(const CLI::App& app, const std::string& word) {
    const std::vector<std::string> names = commandNames(app);
    const std::string near = nearestWord(word, names);
    const bool scene = word.ends_with(".toml") || word.ends_with(".vdb");
    const std::string mend = !near.empty() ? fmt::format("did you mean {}?", near)
                             : scene       ? fmt::format("did you mean lumulus render {}?", word)
                                           : fmt::format("the commands are {}", fmt::join(names, ", "));
    throw InputError("unknown command \"" + word + "\"", "command line", mend);
}

const CLI::App& commandOf(const CLI::App& app, const std::string& name) {
    const CLI::App* command = findCommand(app, name);
    if (command == nullptr) unknownCommand(app, name);
    return *command;
}

void refuseUnknownWords(const CLI::App& app, std::span<const char* const> words) {
    const CLI::App* command = &app;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i];
        if (word == "--") return;
        const std::string name = optionIn(word), meant = typesetOption(word);
        if (!meant.empty())
            throw InputError("unknown option \"" + word + "\"", titleOf(app, *command),
                             takesOption(*command, optionIn(meant))
                                 ? fmt::format("did you mean {}, with plain dashes?", optionIn(meant))
                                 : optionAdvice(app, *command, meant, words.subspan(i + 1)));
        if (name.empty()) {
            if (command != &app) continue;
            command = findCommand(app, word);
            if (command == nullptr) unknownCommand(app, word);
            continue;
        }
        const CLI::Option* option = command->get_option_no_throw(name);
        if (option == nullptr)
            throw InputError("unknown option \"" + word.substr(0, word.find('=')) + "\"", titleOf(app, *command),
                             optionAdvice(app, *command, word, words.subspan(i + 1)));
        if (word != name) continue;  // its value is part of the word
        for (int values = option->get_items_expected_min(); values > 0 && i + 1 < words.size(); --values, ++i)
            if (!optionIn(words[i + 1]).empty()) break;
    }
}

}  // namespace lumulus::cli
