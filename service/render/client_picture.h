#pragma once

#include <vector>

#include "base/image.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Fills the layers R, G, B and A of a client's picture, and returns its depths.
/// Errors: RequestError `bad_request` where a value is no finite number.
std::vector<float> readPixels(const Composite& composite, LayeredImage& picture);

}  // namespace lumulus::service
