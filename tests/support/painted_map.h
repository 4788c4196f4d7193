#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/exr.h"
#include "scene/sky.h"
#include "support/temporary_folder.h"

/// Pictures of surroundings, for what takes them as its sky.

namespace lumulus::test {

using Paint = std::function<glm::dvec3(const glm::dvec3& direction)>;

/// Direction to the middle of a pixel of a latitude-longitude picture: −Z in the middle, +X a quarter to the right.
inline glm::dvec3 mapDirection(int x, int y, int width) {
    const double azimuth = ((x + 0.5) / width - 0.5) * 2.0 * std::numbers::pi;
    const double down = (y + 0.5) / (width / 2) * std::numbers::pi;
    return {std::sin(down) * std::sin(azimuth), std::cos(down), -std::sin(down) * std::cos(azimuth)};
}

/// A latitude-longitude picture of radiances by direction.
inline LayeredImage painted(int width, const Paint& paint) {
    LayeredImage image;
    image.width = width;
    image.height = width / 2;
    for (const char* name : {"R", "G", "B"}) image.layer(name);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 value = paint(mapDirection(x, y, width));
            const auto i = static_cast<std::size_t>(y * width + x);
            image.layers["R"][i] = static_cast<float>(value.x);
            image.layers["G"][i] = static_cast<float>(value.y);
            image.layers["B"][i] = static_cast<float>(value.z);
        }
    return image;
}

/// Smooth, of another colour in each direction.
inline glm::dvec3 smooth(const glm::dvec3& d) {
    return {1.0 + 0.8 * d.x, 1.0 - 0.5 * d.z, 2.0 + d.y};
}

/// With a sun.
inline glm::dvec3 withSpot(const glm::dvec3& d) {
    const double near = glm::dot(d, scene::skyDirection(40.0, 50.0));
    return glm::dvec3(0.2, 0.3, 0.5) +
           (near > std::cos(glm::radians(1.2)) ? glm::dvec3(9000.0, 8000.0, 6000.0) : glm::dvec3(0.0));
}

/// Tests of a class that is made of a sky with a map.
template <class Map>
class PaintedMapTest : public testing::Test {
  protected:
    scene::Sky skyOf(const LayeredImage& image) {
        scene::Sky sky;
        sky.model = scene::SkyModel::map;
        sky.map = folder_.path() / "sky.exr";
        writeExr(sky.map, image);
        return sky;
    }

    std::string messageOf(const scene::Sky& sky) {
        try {
            const Map map(sky);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    void expectBadMapsAreNamed() {
        using testing::AllOf;
        using testing::HasSubstr;
        scene::Sky sky;
        sky.model = scene::SkyModel::map;
        EXPECT_THAT(messageOf(sky), HasSubstr("sky.map"));
        sky.map = folder_.path() / "none.exr";
        EXPECT_THAT(messageOf(sky), AllOf(HasSubstr("sky.map"), HasSubstr("none.exr")));
        std::ofstream(folder_.path() / "text.exr") << "no picture";
        sky.map = folder_.path() / "text.exr";
        EXPECT_THAT(messageOf(sky), AllOf(HasSubstr("sky.map"), HasSubstr("text.exr")));
        LayeredImage image = painted(8, smooth);
        for (const float bad : {std::nanf(""), -1.0F, INFINITY}) {
            image.layers["G"][11] = bad;
            EXPECT_THAT(messageOf(skyOf(image)), AllOf(HasSubstr("sky.map"), HasSubstr("pixel (3, 1)")));
        }
        const auto black = [](const glm::dvec3&) { return glm::dvec3(0.0); };
        EXPECT_THAT(messageOf(skyOf(painted(8, black))), HasSubstr("black"));
        image = painted(8, smooth);
        image.layers.erase("B");
        EXPECT_THAT(messageOf(skyOf(image)), HasSubstr("channel B"));
        image = painted(8, smooth);
        image.height = 2;
        for (auto& [name, layer] : image.layers) layer.resize(16);
        EXPECT_THAT(messageOf(skyOf(image)), AllOf(HasSubstr("8 × 2"), HasSubstr("twice as wide")));
    }

    TemporaryFolder folder_;
};

}  // namespace lumulus::test
