#include "base/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
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

namespace lumulus {
namespace {

namespace fs = std::filesystem;

/// Attributes whose types the format fixes for files of several parts: strict readers refuse a string there.
constexpr std::array<std::string_view, 4> multipartAttributes{"name", "type", "version", "chunkCount"};

/// A slice whose first value belongs to pixel (x0, y0).
Imf::Slice sliceAt(const float* values, int x0, int y0, int width) {
    // OpenEXR takes the address of pixel (0, 0), which may lie outside; Slice::Make does the pointer arithmetic
    const Imath::V2i origin(x0, y0);
    return Imf::Slice::Make(Imf::FLOAT, values, origin, width, 1, sizeof(float),
                            sizeof(float) * static_cast<std::size_t>(width));
}

Imf::Header headerOf(const LayeredImage& image, const std::string& name) {
    Imf::Header header(image.width, image.height);
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

LayeredImage readOpen(Imf::InputFile& file, const fs::path& path) {
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    LayeredImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    if (header.channels().begin() == header.channels().end())
        throw InputError("the picture has no channels", path.string(), "give one with pixels");
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
            throw InputError(std::string("the channel ") + it.name() + " is subsampled", path.string(),
                             "convert the picture to full-resolution RGB first");
        }
    }
    Imf::FrameBuffer frame;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        frame.insert(it.name(), sliceAt(image.layer(it.name()).data(), window.min.x, window.min.y, image.width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (auto it = header.begin(); it != header.end(); ++it) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
            image.attributes[it.name()] = text->value();
        }
    }
    return image;
}

}  // namespace

std::vector<std::byte> encodeExr(const LayeredImage& image, const std::string& name) {
    assert(image.width > 0 && image.height > 0 && !image.layers.empty());
    Imf::FrameBuffer frame;
    for (const auto& [layer, values] : image.layers) {
        assert(values.size() == image.pixels());
        frame.insert(layer, sliceAt(values.data(), 0, 0, image.width));
    }
    // encoded in memory: OpenEXR loses a small picture on a full disk silently
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, headerOf(image, name));
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }
    const std::string text = stream.str();
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

void writeExr(const fs::path& path, const LayeredImage& image) {
    writeFile(path, encodeExr(image, path.string()));
}

LayeredImage readExr(const fs::path& path) {
    std::error_code ec;
    if (!fs::is_regular_file(path, ec)) {
        throw InputError(fs::exists(path, ec) ? "not a file" : "no such file", path.string(), "give an EXR picture");
    }
    try {
        checkExrClaims(path);
        Imf::StdIFStream stream(path.c_str());
        Imf::InputFile file(stream);
        if (!file.isComplete()) {
            throw InputError("the picture is incomplete", path.string(), "write or copy it again");
        }
        return readOpen(file, path);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(std::string("cannot read the picture: ") + e.what(), path.string(), "give an EXR picture");
    }
}

}  // namespace lumulus
