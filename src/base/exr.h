#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"

namespace lumulus {

/// A rectangle of pixels, rows from the top. Its corner may lie anywhere.
struct ExrWindow {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const ExrWindow&) const = default;
};

/// Where the pixels of a picture lie (`data`) in the frame that is shown (`display`).
struct ExrWindows {
    ExrWindow display, data;

    bool operator==(const ExrWindows&) const = default;
};

/// What a part of an EXR file holds.
struct ExrPart {
    std::string name;  ///< empty where the file has one part
    ExrWindows windows;
    std::vector<std::string> channels;  ///< none where the part is deep
};

/// Writes each layer as a 32-bit float channel of the same name (scanlines, ZIP) and attributes as strings in the
/// header. Equal images give equal bytes. Errors: those of writeFile; InputError where an attribute has a name that the
/// format reserves. Without `windows`, whose data window has the size of the picture, both are the picture.
void writeExr(const std::filesystem::path& path, const LayeredImage& image,
              const std::optional<ExrWindows>& windows = std::nullopt);

/// Encodes an image as the bytes of an EXR file. Errors: InputError as for writeExr; `name` is the picture in messages.
std::vector<std::byte> encodeExr(const LayeredImage& image, const std::string& name,
                                 const std::optional<ExrWindows>& windows = std::nullopt);

/// Reads the first part of an EXR file: any compression, scanline or tiled (the full resolution), half, float or
/// unsigned channels, any data window (which becomes the picture). String attributes are read too.
/// Errors: InputError for a file that is unreadable, truncated, deep, subsampled or too large (2^28 values).
LayeredImage readExr(const std::filesystem::path& path);

/// Lists the parts of an EXR file without reading their pixels. Errors: InputError for a file that is unreadable.
std::vector<ExrPart> listExrParts(const std::filesystem::path& path);

/// Reads some channels of a part, as readExr; others may be subsampled. Errors: those of readExr.
LayeredImage readExrChannels(const std::filesystem::path& path, std::size_t part,
                             std::span<const std::string> channels);

}  // namespace lumulus
