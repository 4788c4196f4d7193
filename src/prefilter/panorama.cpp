#include "prefilter/panorama.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lumulus::prefilter {

using std::numbers::pi;

glm::dvec3 Panorama::direction(double x, double y) const {
    const double longitude = 2.0 * pi * (x / width - 0.5), latitude = pi * (0.5 - y / height);
    return {std::cos(latitude) * std::cos(longitude), std::sin(latitude), std::cos(latitude) * std::sin(longitude)};
}

double Panorama::solidAngle(int y) const {
    return 2.0 * pi / width *
           (std::sin(pi * (0.5 - static_cast<double>(y) / height)) - std::sin(pi * (0.5 - (y + 1.0) / height)));
}

glm::vec3 Panorama::at(const glm::dvec3& d) const {
    const double x = (std::atan2(d.z, d.x) / (2.0 * pi) + 0.5) * width - 0.5;
    const double y = (0.5 - std::asin(std::clamp(d.y, -1.0, 1.0)) / pi) * height - 0.5;
    const int left = static_cast<int>(std::floor(x)), upper = static_cast<int>(std::floor(y));
    const auto right = static_cast<float>(x - left), down = static_cast<float>(y - upper);
    const auto row = [&](int line) {
        const glm::vec3* values = pixels.data() + static_cast<std::ptrdiff_t>(std::clamp(line, 0, height - 1)) * width;
        return glm::mix(values[(left + width) % width], values[(left + 1) % width], right);
    };
    return glm::mix(row(upper), row(upper + 1), down);
}

Panorama panoramaOf(int width, int height, std::span<const float> red, std::span<const float> green,
                    std::span<const float> blue) {
    Panorama panorama{width, height, {}};
    assert(red.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto radiance = [](float value) { return std::isfinite(value) ? std::max(value, 0.0F) : 0.0F; };
    panorama.pixels.reserve(red.size());
    for (std::size_t i = 0; i < red.size(); ++i)
        panorama.pixels.emplace_back(radiance(red[i]), radiance(green[i]), radiance(blue[i]));
    return panorama;
}

}  // namespace lumulus::prefilter
