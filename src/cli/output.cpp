#include "cli/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <set>
#include <system_error>

#include "base/atomic_file.h"
#include "base/display_transform.h"
#include "base/error.h"
#include "base/png.h"
#include "base/tonemap.h"
#include "scene/tone.h"

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

void checkPlaces(const std::vector<std::filesystem::path>& outputs) {
    std::set<std::filesystem::path> files;
    for (const auto& output : outputs) {
        if (!files.insert(outputFile(output)).second)
            throw InputError("the same output is given twice", output.string(), "give each output a name of its own");
    }
    for (const auto& output : outputs) checkWritable(output);
}

void writePicture(const std::filesystem::path& path, const LayeredImage& image, const scene::Image& how,
                  const std::optional<ExrWindows>& windows) {
    if (hasSuffix(path, ".exr")) {
        writeExr(path, image, windows);
    } else {
        const auto display = DisplayTransform::ofEnvironment();
        const std::array pictures{&image};
        Tone tone = scene::toneOf(how, pictures);
        tone.display = display ? &*display : nullptr;
        writePng(path, image.width, image.height,
                 how.background ? toneMap(image, tone) : toneMapWithAlpha(image, tone));
    }
}

void printOut(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
    if (errno == EPIPE) return;  // the reader has read enough (| head)
    throw Error("cannot write: " + std::generic_category().message(errno), "standard output",
                "free some space, or give it a place that is open");
}

}  // namespace lumulus::cli
