#include "cli/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "base/error.h"

namespace lumulus::cli {

bool hasSuffix(const std::filesystem::path& path, std::string_view suffix) {
    const std::string extension = path.extension().string();
    return std::ranges::equal(extension, suffix, [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    });
}

void requireSuffix(const std::filesystem::path& path, std::initializer_list<std::string_view> suffixes) {
    for (const std::string_view suffix : suffixes) {
        if (hasSuffix(path, suffix)) return;
    }
    throw InputError(fmt::format("cannot write a file of this kind: \"{}\"", path.extension().string()), path.string(),
                     fmt::format("give a name that ends with {}", fmt::join(suffixes, " or ")));
}

void printOut(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw Error("cannot write: " + std::generic_category().message(errno), "standard output",
                    "free some space, or give it a place that is open");
    }
}

}  // namespace lumulus::cli
