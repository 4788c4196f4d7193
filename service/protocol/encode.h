#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "base/image.h"
#include "service/protocol/requests.h"

namespace lumulus::service {

struct EncodeOptions {
    std::vector<Product> products;
    Encoding encoding = Encoding::half;
    int quality = 85;
    double exposure = 0.0;
};

/// Appends a view to `payload` and says in what it returns what was appended: {"width", "height", "products": [{"name",
/// "channels", "type", "offset", "bytes"}]} for half and float, {"width", "height", "type", "offset", "bytes"} else.
/// `half` rounds to nearest even as IEEE 754 says (beyond 65504 that is infinity); depths are floats always.
nlohmann::json appendView(const LayeredImage& image, const EncodeOptions& options, std::vector<std::byte>& payload);

/// "half", "float", "exr", "png", "jpeg"
const char* encodingName(Encoding encoding);

}  // namespace lumulus::service
