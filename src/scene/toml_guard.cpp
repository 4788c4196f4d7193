#include "scene/toml_guard.h"

#include <string>

#include "base/error.h"

namespace lumulus::scene {
namespace {

constexpr int maximumDots = 8;

/// The position after the string that starts at `i`, or the end of the text if the string never closes.
std::size_t skipString(std::string_view text, std::size_t i) {
    const char quote = text[i];
    const bool tripled = text.substr(i).starts_with(std::string(3, quote));
    const std::string end(tripled ? 3 : 1, quote);
    for (i += end.size(); i < text.size(); ++i) {
        if (quote == '"' && text[i] == '\\') {
            ++i;
        } else if (text.substr(i).starts_with(end)) {
            return i + end.size();
        } else if (!tripled && text[i] == '\n') {
            return i;  // the parser reports it
        }
    }
    return text.size();
}

}  // namespace

void checkKeyDepth(std::string_view text, std::string_view source) {
    int dots = 0;
    std::size_t line = 1;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            const std::size_t end = skipString(text, i);
            for (; i < end; ++i) line += text[i] == '\n' ? 1 : 0;
            continue;
        }
        if (c == '#') {
            while (i < text.size() && text[i] != '\n') ++i;
            continue;
        }
        if (c == '\n') ++line;
        if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots = 0;
        if (c == '.' && ++dots > maximumDots) {
            throw InputError("keys nest too deep", std::string(source) + ":" + std::to_string(line),
                             "docs/scene-format.md lists the keys of a scene");
        }
        ++i;
    }
}

}  // namespace lumulus::scene
