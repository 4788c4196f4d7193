#include "base/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <sstream>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/exr_claims.h"
#include "base/text.h"

namespace lumulus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t maximumValues = std::size_t{1} << 28;

/// Attributes whose types the format fixes for files of several parts: strict readers refuse a string there.
constexpr std::array<std::string_view, 4> multipartAttributes{"name", "type", "version", "chunkCount"};

/// A slice whose first value belongs to pixel (x0, y0).
Imf::Slice sliceAt(const float* values, int x0, int y0, int width) {
    // OpenEXR takes the address of pixel (0, 0), which may lie outside; Slice::Make does the pointer arithmetic
    const Imath::V2i origin(x0, y0);
    return Imf::Slice::Make(Imf::FLOAT, values, origin, width, 1, sizeof(float),
                            sizeof(float) * static_cast<std::size_t>(width));
}

Imath::Box2i boxOf(const ExrWindow& window) {
    return {{window.x, window.y}, {window.x + window.width - 1, window.y + window.height - 1}};
}

ExrWindow windowOf(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

Imf::Header headerOf(const LayeredImage& image, const std::string& name, const ExrWindows& windows) {
    Imf::Header header(boxOf(windows.display), boxOf(windows.data));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [attribute, text] : image.attributes) {
        if (header.find(attribute.c_str()) != header.end() || std::ranges::count(multipartAttributes, attribute) > 0) {
            throw InputError("the attribute \"" + attribute + "\" is reserved by the format", name,
                             "give it another name");
        }
        header.insert(attribute, Imf::StringAttribute(text));
    }
    for (const auto& layer : image.layers) header.channels().insert(layer.first, Imf::Channel(Imf::FLOAT));
    return header;
}

void requireFull(const Imf::ChannelList& channels, const std::string& name, const fs::path& path) {
    const Imf::Channel& channel = channels[name.c_str()];
    if (channel.xSampling == 1 && channel.ySampling == 1) return;
    throw InputError("the channel " + name + " is subsampled", path.string(),
                     "convert the picture to full-resolution RGB first");
}

bool isDeep(const Imf::Header& header) {
    return header.hasType() && Imf::isDeepData(header.type());
}

std::vector<std::string> namesOf(const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    for (auto it = channels.begin(); it != channels.end(); ++it) names.emplace_back(it.name());
    return names;
}

LayeredImage readOpen(Imf::MultiPartInputFile& file, std::size_t number, std::span<const std::string> names,
                      const fs::path& path) {
    const Imf::Header& header = file.header(static_cast<int>(number));
    if (isDeep(header)) throw InputError("the picture is deep", path.string(), "flatten it first");
    Imf::InputPart part(file, static_cast<int>(number));
    if (!part.isComplete()) {
        throw InputError("the picture is incomplete", path.string(), "write or copy it again");
    }
    const Imath::Box2i window = header.dataWindow();
    LayeredImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    if (names.empty()) throw InputError("the picture has no channels", path.string(), "give one with pixels");
    for (const std::string& name : names) requireFull(header.channels(), name, path);
    if (image.pixels() > maximumValues / names.size()) {
        throw InputError("the picture is too large to read", path.string(), "crop it or drop some layers");
    }
    Imf::FrameBuffer frame;
    for (const std::string& name : names)
        frame.insert(name, sliceAt(image.layer(name).data(), window.min.x, window.min.y, image.width));
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
    for (auto it = header.begin(); it != header.end(); ++it) {
        const bool ofThePart = std::ranges::count(multipartAttributes, std::string_view(it.name())) > 0;
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
        if (text != nullptr && !ofThePart) image.attributes[it.name()] = text->value();
    }
    return image;
}

/// What `read` makes of the opened file. Errors of the library become bad input.
template <typename Read>
auto opened(const fs::path& path, const Read& read) {
    std::error_code ec;
    if (!fs::is_regular_file(path, ec)) {
        throw InputError(fs::exists(path, ec) ? "not a file" : "no such file", path.string(), "give an EXR picture");
    }
    try {
        checkExrClaims(path);
        Imf::StdIFStream stream(path.c_str());
        Imf::MultiPartInputFile file(stream);
        return read(file);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(std::string("cannot read the picture: ") + oneLine(e.what()), path.string(),
                         "give an EXR picture");
    }
}

}  // namespace

std::vector<std::byte> encodeExr(const LayeredImage& image, const std::string& name,
                                 const std::optional<ExrWindows>& windows) {
    assert(image.width > 0 && image.height > 0 && !image.layers.empty());
    const ExrWindow whole{0, 0, image.width, image.height};
    const ExrWindows placed = windows.value_or(ExrWindows{whole, whole});
    assert(placed.data.width == image.width && placed.data.height == image.height);
    Imf::FrameBuffer frame;
    for (const auto& [layer, values] : image.layers) {
        assert(values.size() == image.pixels());
        frame.insert(layer, sliceAt(values.data(), placed.data.x, placed.data.y, image.width));
    }
    // encoded in memory: OpenEXR loses a small picture on a full disk silently
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, headerOf(image, name, placed));
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }
    const std::string text = stream.str();
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

void writeExr(const fs::path& path, const LayeredImage& image, const std::optional<ExrWindows>& windows) {
    writeFile(path, encodeExr(image, path.string(), windows));
}

LayeredImage readExr(const fs::path& path) {
    return opened(path, [&](Imf::MultiPartInputFile& file) {
        return readOpen(file, 0, namesOf(file.header(0).channels()), path);
    });
}

std::vector<ExrPart> listExrParts(const fs::path& path) {
    return opened(path, [](Imf::MultiPartInputFile& file) {
        std::vector<ExrPart> parts;
        for (int i = 0; i < file.parts(); ++i) {
            const Imf::Header& header = file.header(i);
            parts.push_back({header.hasName() ? header.name() : std::string(),
                             {windowOf(header.displayWindow()), windowOf(header.dataWindow())},
                             isDeep(header) ? std::vector<std::string>() : namesOf(header.channels())});
        }
        return parts;
    });
}

LayeredImage readExrChannels(const fs::path& path, std::size_t part, std::span<const std::string> channels) {
    return opened(path, [&](Imf::MultiPartInputFile& file) { return readOpen(file, part, channels, path); });
}

}  // namespace lumulus
