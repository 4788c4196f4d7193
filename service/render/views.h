#pragma once

#include <cstdint>
#include <vector>

#include "service/values/requests.h"
#include "view/view.h"

namespace lumulus::service {

/// The views that a request asks for; what it leaves out is taken from `sceneView`. `bounds` are those of the cloud, at
/// which a camera without a position looks.
/// Errors: RequestError `bad_request` for cameras and tiles that cannot be, `too_large` for more than `mostPixels`.
std::vector<View> viewsOf(const std::vector<ViewRequest>& requests, const View& sceneView, const Bounds& bounds,
                          std::uint64_t mostPixels);

/// Pixels of all views together, of tiles where there are some.
std::uint64_t pixelsOf(const std::vector<View>& views);

}  // namespace lumulus::service
