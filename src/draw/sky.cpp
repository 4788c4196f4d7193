#include "draw/sky.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

namespace lumulus::draw {

LayeredImage skyImage(const Camera& camera, const Tile& tile, const scene::Sun& sun, const scene::Sky& sky) {
    LayeredImage image;
    image.width = tile.width;
    image.height = tile.height;
    auto& red = image.layer("R");
    auto& green = image.layer("G");
    auto& blue = image.layer("B");
    for (const char* name : {"A", "cloud.R", "cloud.G", "cloud.B"}) image.layer(name, 0.0F);
    for (const char* name : {"transmittance.R", "transmittance.G", "transmittance.B"}) image.layer(name, 1.0F);
    for (const char* name : {"depth.Z", "depth.front"}) image.layer(name, shared::FAR_DEPTH);

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
    const std::size_t begin = static_cast<std::size_t>(firstRow) * width;
    const std::size_t count = static_cast<std::size_t>(rows) * width;
    const auto rgb = [&](const std::string& prefix, glm::vec3 shared::Pixel::*member) {
        const char* names[3] = {"R", "G", "B"};
        for (int channel = 0; channel < 3; ++channel) {
            std::vector<float>& layer = image.layer(prefix + names[channel]);
            for (std::size_t i = 0; i < count; ++i) layer[begin + i] = (pixels[i].*member)[channel];
        }
    };
    const auto scalar = [&](const char* name, float shared::Pixel::*member) {
        std::vector<float>& layer = image.layer(name);
        for (std::size_t i = 0; i < count; ++i) layer[begin + i] = pixels[i].*member;
    };
    rgb("", &shared::Pixel::radiance);
    rgb("cloud.", &shared::Pixel::cloud);
    rgb("transmittance.", &shared::Pixel::transmittance);
    scalar("A", &shared::Pixel::alpha);
    scalar("depth.Z", &shared::Pixel::depth);
    scalar("depth.front", &shared::Pixel::front);
}

}  // namespace lumulus::draw
