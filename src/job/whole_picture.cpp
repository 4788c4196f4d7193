#include "job/whole_picture.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/exr.h"

namespace lumulus::job {

namespace {

/// A PNG file ends with an empty chunk, whose checksum is always the same.
bool endsLikePng(const std::filesystem::path& path) {
    constexpr std::array<char, 12> wanted{0, 0, 0, 0, 'I', 'E', 'N', 'D', '\xAE', '\x42', '\x60', '\x82'};
    std::array<char, 12> end{};
    std::ifstream file(path, std::ios::binary);
    std::array<char, 4> begin{};
    file.read(begin.data(), begin.size());
    file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
    file.read(end.data(), end.size());
    return file.good() && std::string_view(begin.data(), begin.size()) == "\x89PNG" && end == wanted;
}

}  // namespace

bool isWholePicture(const std::filesystem::path& path) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(path, ec)) return false;
    if (endsLikePng(path)) return true;
    try {
        const std::array<std::string, 1> one{"R"};  // of all lines; a large picture need not fit into memory as a whole
        return !readExrChannels(path, 0, one).layers.empty();
    } catch (const Error&) {
        return false;
    }
}

}  // namespace lumulus::job
