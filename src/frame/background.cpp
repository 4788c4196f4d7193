#include "frame/background.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace lumulus::frame {

namespace {

bool seesSun(const Camera& camera, double px, double py, const glm::dvec3& directionTo, double radius) {
    const glm::dvec3 direction = camera.ray(px, py).direction;
    return 2.0 * std::atan2(glm::length(direction - directionTo), glm::length(direction + directionTo)) <= radius;
}

/// Part of a pixel's rays, a grid of `rays` along each side, that meet the disc.
double sunInPixel(const Camera& camera, int x, int y, int rays, const glm::dvec3& directionTo, double radius) {
    int met = 0;
    for (int i = 0; i < rays * rays; ++i)
        met += seesSun(camera, x + (i % rays + 0.5) / rays, y + (i / rays + 0.5) / rays, directionTo, radius);
    return static_cast<double>(met) / (rays * rays);
}

/// Whether a disc may be seen at all: by the angles between the middle of a perspective view and its corners.
bool maySeeSun(const Camera& camera, const glm::dvec3& directionTo, double radius) {
    if (camera.projection != scene::Projection::perspective) return true;
    const glm::dvec3 middle = camera.ray(0.5 * camera.width, 0.5 * camera.height).direction;
    double least = 1.0;
    for (int i = 0; i < 4; ++i)
        least = std::min(least,
                         glm::dot(middle, camera.ray(i & 1 ? camera.width : 0, i & 2 ? camera.height : 0).direction));
    return std::acos(std::clamp(glm::dot(middle, directionTo), -1.0, 1.0)) <= std::acos(least) + radius;
}

}  // namespace

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

std::vector<shared::SunPixel> sunPixels(const Camera& camera, const Tile& tile, const scene::Sun& sun,
                                        const sky::Environment& environment, int rays, const Tile& without) {
    const double radius = 0.5 * sun.angularDiameter * std::numbers::pi / 180.0;
    const double disc = std::numbers::pi * std::pow(std::sin(radius), 2);
    if (!(disc > 0.0) || !maySeeSun(camera, sun.directionTo, radius)) return {};
    std::vector<std::vector<shared::SunPixel>> rows(static_cast<std::size_t>(tile.height));
    tbb::parallel_for(tile.y, tile.y + tile.height, [&](int y) {
        const auto find = [&](int first, int end) {
            for (int x = first; x < end; ++x) {
                const double share = sunInPixel(camera, x, y, rays, sun.directionTo, radius);
                if (share > 0.0)
                    rows[static_cast<std::size_t>(y - tile.y)].push_back(
                        {{x, y}, glm::vec3(environment.radiance(sun.directionTo) + share * sun.irradiance / disc)});
            }
        };
        const bool crosses = y >= without.y && y < without.y + without.height;
        find(tile.x, crosses ? without.x : tile.x + tile.width);
        if (crosses) find(without.x + without.width, tile.x + tile.width);
    });
    std::vector<shared::SunPixel> pixels;
    for (const auto& row : rows) pixels.insert(pixels.end(), row.begin(), row.end());
    return pixels;
}

LayeredImage skyImage(const Camera& camera, const Tile& tile, const scene::Sun& sun,
                      const sky::Environment& environment, int rays, const Tile& without) {
    LayeredImage image = emptyFrame(tile, environment.uniformRadiance());
    const std::array<std::vector<float>*, 3> colours{&image.layer("R"), &image.layer("G"), &image.layer("B")};
    for (const shared::SunPixel& seen : sunPixels(camera, tile, sun, environment, rays, without)) {
        const auto i = static_cast<std::size_t>(seen.pixel.y - tile.y) * static_cast<std::size_t>(tile.width) +
                       static_cast<std::size_t>(seen.pixel.x - tile.x);
        for (int c = 0; c < 3; ++c) (*colours[static_cast<std::size_t>(c)])[i] = seen.radiance[c];
    }
    return image;
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
