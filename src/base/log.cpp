#include "base/log.h"

#include <cstdio>

namespace lumulus {
namespace {

void print(std::string_view kind, std::string_view text) {
    // one call, so that lines of several threads do not mix
    const std::string line = "lumulus: " + std::string(kind) + ": " + oneLine(text) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

std::string oneLine(std::string_view text) {
    std::string line(text);
    for (char& c : line) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7F) c = ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

void logWarning(std::string_view text) {
    print("warning", text);
}

void logError(std::string_view text) {
    print("error", text);
}

}  // namespace lumulus
