#include "base/exr_mip.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <sstream>

namespace lumulus {

namespace {

Imf::FrameBuffer bufferOf(const LayeredImage& image) {
    Imf::FrameBuffer frame;
    const Imath::V2i origin(0, 0);
    for (const auto& [name, values] : image.layers)
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), origin, image.width, image.height, sizeof(float),
                                            sizeof(float) * static_cast<std::size_t>(image.width)));
    return frame;
}

}  // namespace

int mipLevels(int width, int height) {
    return std::bit_width(static_cast<unsigned>(std::max(width, height)));
}

std::vector<std::byte> encodeMipMapped(std::span<const LayeredImage> levels, bool cubeMap) {
    constexpr unsigned tile = 64;
    const LayeredImage& whole = levels.front();
    assert(static_cast<int>(levels.size()) == mipLevels(whole.width, whole.height));
    Imf::Header header(whole.width, whole.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.setTileDescription(Imf::TileDescription(tile, tile, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
    for (const auto& [name, text] : whole.attributes) header.insert(name.c_str(), Imf::StringAttribute(text));
    if (cubeMap) Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    for (const auto& layer : whole.layers) header.channels().insert(layer.first, Imf::Channel(Imf::FLOAT));
    Imf::StdOSStream stream;  // in memory, as encodeExr
    {
        Imf::TiledOutputFile file(stream, header);
        for (int level = 0; level < file.numLevels(); ++level) {
            const LayeredImage& image = levels[static_cast<std::size_t>(level)];
            assert(image.width == file.levelWidth(level) && image.height == file.levelHeight(level));
            file.setFrameBuffer(bufferOf(image));
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    const std::string text = stream.str();
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

}  // namespace lumulus
