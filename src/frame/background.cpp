#include "frame/background.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

namespace lumulus::frame {

LayeredImage emptyFrame(const Tile& tile, const glm::dvec3& radiance) {
    constexpr float none = 0.0F, all = 1.0F;
    const glm::vec3 background(radiance);
    const std::array<std::pair<const char*, float>, 13> values{{{"R", background.r},
                                                                {"G", background.g},
                                                                {"B", background.b},
                                                                {"A", all},
                                                                {"cloud.R", none},
                                                                {"cloud.G", none},
                                                                {"cloud.B", none},
                                                                {"cloud.A", none},
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

void addSun(LayeredImage& image, const std::vector<shared::SunPixel>& pixels) {
    const std::array<std::vector<float>*, 3> colours{&image.layer("R"), &image.layer("G"), &image.layer("B")};
    const std::vector<float>& passed = image.layer("transmittance.R");
    for (const shared::SunPixel& seen : pixels) {
        const auto i = static_cast<std::size_t>(seen.pixel.y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(seen.pixel.x);
        for (int c = 0; c < 3; ++c) (*colours[static_cast<std::size_t>(c)])[i] += seen.radiance[c] * passed[i];
    }
}

void leaveOutBackground(LayeredImage& image) {
    for (const char* name : {"R", "G", "B", "A"}) image.layers.at(name) = image.layers.at(std::string("cloud.") + name);
}

void copyPixels(std::span<const shared::Pixel> pixels, LayeredImage& image, const Tile& place) {
    const auto across = static_cast<std::size_t>(image.width), width = static_cast<std::size_t>(place.width);
    // a pixel's floats in the order of its members; what is seen through is the same for all colours
    const std::array<const char*, 10> names{
        "cloud.R", "cloud.G", "cloud.B", "transmittance.R", "cloud.A", "depth.Z", "depth.front", "R", "G", "B"};
    constexpr std::size_t transmittance = 3;
    static_assert(offsetof(shared::Pixel, unused) == std::tuple_size_v<decltype(names)> * sizeof(float));
    std::array<float*, names.size()> layers{};
    for (std::size_t i = 0; i < names.size(); ++i) layers[i] = image.layer(names[i]).data();
    std::array<float*, 2> transmittances{image.layer("transmittance.G").data(), image.layer("transmittance.B").data()};
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(place.height), [&](std::size_t row) {
        const std::size_t to = (static_cast<std::size_t>(place.y) + row) * across + static_cast<std::size_t>(place.x);
        for (std::size_t x = 0; x < width; ++x) {
            const auto values =
                std::bit_cast<std::array<float, sizeof(shared::Pixel) / sizeof(float)>>(pixels[row * width + x]);
            for (std::size_t i = 0; i < names.size(); ++i) layers[i][to + x] = values[i];
        }
        for (float* copy : transmittances) std::copy_n(layers[transmittance] + to, width, copy + to);
    });
}

}  // namespace lumulus::frame
