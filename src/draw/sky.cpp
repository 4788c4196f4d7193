#include "draw/sky.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace lumulus::draw {

LayeredImage emptyFrame(const Tile& tile) {
    constexpr float none = 0.0F, all = 1.0F;
    const std::array<std::pair<const char*, float>, 12> values{{{"R", none},
                                                                {"G", none},
                                                                {"B", none},
                                                                {"A", none},
                                                                {"cloud.R", none},
                                                                {"cloud.G", none},
                                                                {"cloud.B", none},
                                                                {"transmittance.R", all},
                                                                {"transmittance.G", all},
                                                                {"transmittance.B", all},
                                                                {"depth.Z", shared::FAR_DEPTH},
                                                                {"depth.front", shared::FAR_DEPTH}}};
    LayeredImage image;
    image.width = tile.width;
    image.height = tile.height;
    for (const auto& value : values) image.layers[value.first];
    // the first touch of so much memory takes longer than its values
    tbb::parallel_for(std::size_t{0}, values.size(), [&](std::size_t i) {
        image.layers.at(values[i].first).assign(image.pixels(), values[i].second);
    });
    return image;
}

LayeredImage skyImage(const Camera& camera, const Tile& tile, const scene::Sun& sun, const scene::Sky& sky) {
    LayeredImage image = emptyFrame(tile);
    auto& red = image.layer("R");
    auto& green = image.layer("G");
    auto& blue = image.layer("B");
    const double radius = 0.5 * sun.angularDiameter * std::numbers::pi / 180.0;
    const double disc = std::numbers::pi * std::pow(std::sin(radius), 2);
    tbb::parallel_for(0, tile.height, [&](int y) {
        for (int x = 0; x < tile.width; ++x) {
            glm::dvec3 radiance = sky.radiance;
            const glm::dvec3 direction = camera.ray(tile.x + x + 0.5, tile.y + y + 0.5).direction;
            const double angle =
                2.0 * std::atan2(glm::length(direction - sun.directionTo), glm::length(direction + sun.directionTo));
            if (disc > 0.0 && angle <= radius) radiance += sun.irradiance / disc;
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.width) + static_cast<std::size_t>(x);
            red[i] = static_cast<float>(radiance.x);
            green[i] = static_cast<float>(radiance.y);
            blue[i] = static_cast<float>(radiance.z);
        }
    });
    return image;
}

void copyPixels(std::span<const shared::Pixel> pixels, LayeredImage& image, int firstRow, int rows) {
    const auto width = static_cast<std::size_t>(image.width);
    // a pixel's floats in the order of its members; what is seen through is the same for all colours
    const std::array<const char*, 10> names{
        "R", "G", "B", "cloud.R", "cloud.G", "cloud.B", "transmittance.R", "A", "depth.Z", "depth.front"};
    constexpr std::size_t transmittance = 6;
    static_assert(sizeof(shared::Pixel) == std::tuple_size_v<decltype(names)> * sizeof(float));
    std::array<float*, names.size()> layers{};
    for (std::size_t i = 0; i < names.size(); ++i) layers[i] = image.layer(names[i]).data();
    std::array<float*, 2> transmittances{image.layer("transmittance.G").data(), image.layer("transmittance.B").data()};
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(rows), [&](std::size_t row) {
        const std::size_t to = (static_cast<std::size_t>(firstRow) + row) * width;
        for (std::size_t x = 0; x < width; ++x) {
            const auto values = std::bit_cast<std::array<float, names.size()>>(pixels[row * width + x]);
            for (std::size_t i = 0; i < values.size(); ++i) layers[i][to + x] = values[i];
        }
        for (float* copy : transmittances) std::copy_n(layers[transmittance] + to, width, copy + to);
    });
}

}  // namespace lumulus::draw
