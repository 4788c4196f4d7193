#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace lumulus::cli {

/// The word of `known` that `word` is most likely a misspelling of, by edit distance; empty if none is near.
std::string nearestWord(std::string_view word, std::span<const std::string> known);

/// The names of all commands, in the order of the help.
std::vector<std::string> commandNames(const CLI::App& app);

/// A command by its name. Errors: the InputError of unknownCommand.
const CLI::App& commandOf(const CLI::App& app, const std::string& name);

/// Throws the InputError of a command that does not exist, with the nearest one.
[[noreturn]] void unknownCommand(const CLI::App& app, const std::string& word);

/// Looks for the first word of a command line (without the program's name) that is no command where one must stand, or
/// no option of its command. A parser that goes from left to right blames the words behind it instead.
/// Errors: InputError with that word and the nearest right one.
void refuseUnknownWords(const CLI::App& app, std::span<const char* const> words);

}  // namespace lumulus::cli
