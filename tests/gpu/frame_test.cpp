// Layers of a picture on the GPU: what is put in comes out, once.
#include "frame/frame.h"

#include <gtest/gtest.h>

#include "frame/background.h"
#include "support/drawn_frame.h"
#include "support/vulkan_fixture.h"

namespace lumulus::frame {
namespace {

constexpr glm::vec3 sky(0.1F, 0.2F, 0.7F);

/// A pixel whose values are all different.
shared::Pixel numbered(std::size_t i) {
    const float n = 0.37F * static_cast<float>(i);
    return {glm::vec3(n, n + 1.0F, n + 2.0F),        n + 3.0F,       n + 4.0F, n + 5.0F, n + 6.0F,
            glm::vec3(n + 7.0F, n + 8.0F, n + 9.0F), glm::vec2(0.0F)};
}

std::vector<shared::Pixel> numberedPixels(const Tile& place) {
    std::vector<shared::Pixel> pixels;
    for (std::size_t i = 0; i < static_cast<std::size_t>(place.width * place.height); ++i)
        pixels.push_back(numbered(i));
    return pixels;
}

class FrameTest : public test::VulkanTest {
  protected:
    LayeredImage filled(const glm::ivec2& size, const Tile& place, const std::vector<shared::SunPixel>& sun,
                        const Tile& part) {
        Frame frame(context, size);
        test::fillFrame(context, frame, sky, numberedPixels(place), place, sun);
        gpu::Commands commands(context);
        std::vector<gpu::PassTime> times;
        LayeredImage image = frame.download(commands, part, times);
        EXPECT_EQ(times.size(), 1U);
        return image;
    }
};

/// Sky, the sun and drawn pixels, as the host would put them into an image.
LayeredImage expected(const glm::ivec2& size, const Tile& place, const std::vector<shared::SunPixel>& sun) {
    LayeredImage image = emptyFrame({0, 0, size.x, size.y}, glm::dvec3(sky));
    copyPixels(numberedPixels(place), image, place);
    for (const shared::SunPixel& seen : sun) {
        const auto i = static_cast<std::size_t>(seen.pixel.y * size.x + seen.pixel.x);
        const float passed = image.layers.at("transmittance.R")[i];
        image.layers.at("R")[i] += passed * seen.radiance.x;
        image.layers.at("G")[i] += passed * seen.radiance.y;
        image.layers.at("B")[i] += passed * seen.radiance.z;
    }
    return image;
}

TEST_F(FrameTest, WhatIsPutInComesOut) {
    const glm::ivec2 size(37, 21);
    const Tile place{5, 3, 17, 9};
    const std::vector<shared::SunPixel> sun{
        {{0, 0}, {3.0F, 4.0F, 5.0F}}, {{6, 4}, {1.0F, 2.0F, 3.0F}}, {{36, 20}, {6.0F, 7.0F, 8.0F}}};
    EXPECT_EQ(filled(size, place, sun, {0, 0, size.x, size.y}).layers, expected(size, place, sun).layers);
}

TEST_F(FrameTest, OnlyTheWantedPartIsRead) {
    const Tile part{4, 2, 7, 5};
    const std::uint64_t before = context.transfers().downloaded;
    const LayeredImage image = filled({37, 21}, {5, 3, 17, 9}, {}, part);
    EXPECT_EQ(context.transfers().downloaded - before, 7U * 5U * sizeof(shared::Pixel));
    EXPECT_EQ(image.width, 7);
    const LayeredImage whole = expected({37, 21}, {5, 3, 17, 9}, {});
    for (const auto& [name, values] : image.layers)
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(values[i], whole.layers.at(name)[(i / 7 + 2) * 37 + i % 7 + 4]) << name;
}

/// More pixels than are read at once.
TEST_F(FrameTest, LargePicturesAreReadInBands) {
    const glm::ivec2 size(1031, 517);
    const Tile place{1, 2, 1000, 500};
    EXPECT_EQ(filled(size, place, {}, {0, 0, size.x, size.y}).layers, expected(size, place, {}).layers);
}

}  // namespace
}  // namespace lumulus::frame
