#include "base/log.h"

#include <cstdio>
#include <string>

#include "base/text.h"

namespace lumulus {
namespace {

/// Longest message in bytes. Messages quote names of any length; the cause and the remedy stand at their two ends.
constexpr std::size_t longestText = 800;

void print(std::string_view kind, std::string_view text) {
    // one write, so that lines of several threads do not mix
    const std::string line = "lumulus: " + std::string(kind) + shortened(oneLine(text), longestText) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void logNote(std::string_view text) {
    print("", text);
}

void logWarning(std::string_view text) {
    print("warning: ", text);
}

void logError(std::string_view text) {
    print("error: ", text);
}

}  // namespace lumulus
