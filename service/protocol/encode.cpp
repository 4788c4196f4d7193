#include "service/protocol/encode.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstring>
#include <string_view>

#include "base/exr.h"
#include "base/jpeg.h"
#include "base/png.h"
#include "base/tonemap.h"
#include "service/protocol/half_pixels.h"
#include "service/values/sha256.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

struct ProductLayers {
    const char* name;
    std::vector<const char*> layers;
    bool depth;  ///< beyond what half can hold
};

const ProductLayers& layersOf(Product product) {
    static const std::array<ProductLayers, 5> all{{
        {"color", {"R", "G", "B", "A"}, false},
        {"cloud", {"cloud.R", "cloud.G", "cloud.B", "cloud.A"}, false},
        {"transmittance", {"transmittance.R", "transmittance.G", "transmittance.B"}, false},
        {"depth", {"depth.Z"}, true},
        {"front", {"depth.front"}, true},
    }};
    return all.at(static_cast<std::size_t>(product));
}

std::vector<const float*> planes(const LayeredImage& image, const ProductLayers& product) {
    std::vector<const float*> result;
    for (const char* name : product.layers) result.push_back(image.layers.at(name).data());
    return result;
}

/// Pixel by pixel from layer by layer.
void interleaveFloats(std::span<const float* const> planes, std::size_t count, std::byte* out) {
    for (std::size_t i = 0; i < count; ++i)
        for (const float* plane : planes) {
            std::memcpy(out, plane + i, sizeof(float));
            out += sizeof(float);
        }
}

json appendProduct(const LayeredImage& image, Product product, bool half, std::vector<std::byte>& payload) {
    const ProductLayers& layers = layersOf(product);
    const bool narrow = half && !layers.depth;
    const std::size_t offset = payload.size();
    const std::size_t bytes = image.pixels() * layers.layers.size() * (narrow ? 2 : sizeof(float));
    payload.resize(offset + bytes);
    const std::vector<const float*> all = planes(image, layers);
    const std::size_t row = static_cast<std::size_t>(image.width), rows = static_cast<std::size_t>(image.height);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows), [&](const tbb::blocked_range<std::size_t>& some) {
        std::vector<const float*> from = all;
        for (const float*& plane : from) plane += some.begin() * row;
        std::byte* to = payload.data() + offset + some.begin() * (bytes / rows);
        (narrow ? interleaveHalves : interleaveFloats)(from, some.size() * row, to);
    });
    return {{"name", layers.name},
            {"channels", layers.layers.size()},
            {"type", narrow ? "half" : "float"},
            {"offset", offset},
            {"bytes", bytes}};
}

std::vector<std::byte> pictureFile(const LayeredImage& image, const EncodeOptions& options) {
    if (options.format.encoding == Encoding::exr) {
        LayeredImage wanted;
        wanted.width = image.width;
        wanted.height = image.height;
        wanted.attributes = image.attributes;
        for (const Product product : options.products)
            for (const char* name : layersOf(product).layers) wanted.layers[name] = image.layers.at(name);
        return encodeExr(wanted, "frame");
    }
    Tone tone = options.tone;
    tone.stops = options.format.exposure.value_or(tone.stops);
    if (options.format.encoding == Encoding::jpeg)
        return encodeJpeg(image.width, image.height, toneMap(image, tone), options.format.quality);
    return encodePng(image.width, image.height,
                     options.background ? toneMap(image, tone) : toneMapWithAlpha(image, tone));
}

}  // namespace

const char* encodingName(Encoding encoding) {
    static constexpr std::array<const char*, encodings> names{"half", "float", "exr", "png", "jpeg"};
    return names.at(static_cast<std::size_t>(encoding));
}

void appendPicture(const LayeredImage& image, const EncodeOptions& options, EncodedPictures& pictures) {
    const Encoding encoding = options.format.encoding;
    std::vector<std::byte>& payload = pictures.payload;
    json view{{"width", image.width}, {"height", image.height}};
    if (encoding == Encoding::half || encoding == Encoding::raw) {
        view["products"] = json::array();
        for (const Product product : options.products)
            view["products"].push_back(appendProduct(image, product, encoding == Encoding::half, payload));
    } else {
        const std::vector<std::byte> file = pictureFile(image, options);
        view["type"] = encodingName(encoding);
        view["offset"] = payload.size();
        view["bytes"] = file.size();
        payload.insert(payload.end(), file.begin(), file.end());
    }
    pictures.views.push_back(std::move(view));
    pictures.pixels += image.pixels();
}

void hashPayload(EncodedPictures& pictures) {
    pictures.hash = "sha256:" + sha256Hex(pictures.payload);
}

}  // namespace lumulus::service
