#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/image.h"
#include "base/tonemap.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// How the pictures of a request are encoded.
struct EncodeOptions {
    std::vector<Product> products;
    PictureFormat format;
    Tone tone;               ///< of the scene; a format may name other stops
    bool background = true;  ///< false: R, G, B are premultiplied by A, and PNG files have alpha
};

/// The pictures of a frame, encoded: the payload of its reply and the description of it.
struct EncodedPictures {
    std::vector<std::byte> payload;
    nlohmann::json views = nlohmann::json::array();
    nlohmann::json hash;  ///< "sha256:…" of the payload, or null
    std::uint64_t pixels = 0;
};

/// Encodes a picture behind those that are there. Its description is {"width", "height", "products": [{"name",
/// "channels", "type", "offset", "bytes"}]} for half and float, and {"width", "height", "type", "offset", "bytes"} for
/// files. `half` rounds to the nearest even as IEEE 754 says, so that values beyond 65504 become infinite; depths are
/// always floats. The same picture gives the same bytes.
void appendPicture(const LayeredImage& image, const EncodeOptions& options, EncodedPictures& pictures);

/// Hashes the payload.
void hashPayload(EncodedPictures& pictures);

/// "half", "float", "exr", "png" or "jpeg".
const char* encodingName(Encoding encoding);

}  // namespace lumulus::service
