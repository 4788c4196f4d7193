#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "prefilter/layouts.h"
#include "prefilter/panorama.h"

namespace lumulus::prefilter {
namespace {

void expectTowards(const glm::vec3& direction, const glm::vec3& wanted) {
    EXPECT_LT(glm::length(direction - glm::normalize(wanted)), 1e-5F)
        << direction.x << " " << direction.y << " " << direction.z;
}

/// The drawing in OpenEXR's ImfEnvmap.h: numbered corners of the cube, upper left and lower right of each face.
TEST(Layouts, CubeIsThatOfTheDrawing) {
    const auto corner = [](int number) {  // bits: x, y, z
        return glm::vec3(number % 2 == 0 ? -1.0F : 1.0F, (number & 2) != 0 ? 1.0F : -1.0F, number < 4 ? -1.0F : 1.0F);
    };
    const std::vector<glm::ivec2> upperLeftLowerRight{{3, 5}, {6, 0}, {6, 3}, {0, 5}, {7, 4}, {2, 1}};
    for (const int size : {2, 16}) {
        const std::vector<glm::vec3> pixels = openExrCube(size);
        ASSERT_EQ(pixels.size(), static_cast<std::size_t>(6 * size * size));
        for (int face = 0; face < 6; ++face) {
            const auto first = static_cast<std::size_t>(face * size * size);
            expectTowards(pixels[first], corner(upperLeftLowerRight[static_cast<std::size_t>(face)].x));
            expectTowards(pixels[first + static_cast<std::size_t>(size * size) - 1],
                          corner(upperLeftLowerRight[static_cast<std::size_t>(face)].y));
        }
    }
    EXPECT_EQ(openExrCube(1).size(), 6U);
    expectTowards(openExrCube(1)[2], {0.0F, 1.0F, 0.0F});
}

/// Table 8.19 of the OpenGL 4.6 specification backwards: the major axis and the texture coordinates of directions.
TEST(Layouts, FacesAreThoseOfGraphicsInterfaces) {
    constexpr int size = 8;
    for (int face = 0; face < 6; ++face) {
        const std::vector<glm::vec3> pixels = graphicsFace(face, size);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const glm::vec3 r = pixels[static_cast<std::size_t>(y * size + x)];
                const std::array<glm::vec3, 6> scTcMa{{{-r.z, -r.y, r.x},
                                                       {r.z, -r.y, -r.x},
                                                       {r.x, r.z, r.y},
                                                       {r.x, -r.z, -r.y},
                                                       {r.x, -r.y, r.z},
                                                       {-r.x, -r.y, -r.z}}};
                const glm::vec3 c = scTcMa[static_cast<std::size_t>(face)];
                EXPECT_GT(c.z, 0.57F);
                EXPECT_NEAR(0.5F * (c.x / c.z + 1.0F) * size, static_cast<float>(x) + 0.5F, 1e-4F);
                EXPECT_NEAR(0.5F * (c.y / c.z + 1.0F) * size, static_cast<float>(y) + 0.5F, 1e-4F);
            }
    }
}

/// What three.js and Blender (with its Z up and our −Z its Y) compute for a direction.
TEST(Layouts, LatLongIsThatOfViewers) {
    using std::numbers::pi;
    constexpr int width = 64, height = 32;
    const std::vector<glm::vec3> pixels = latLong(width, height);
    double sum = 0.0;
    const Panorama shape{width, height, {}};
    for (int y = 0; y < height; ++y) {
        sum += width * shape.solidAngle(y);
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 d(pixels[static_cast<std::size_t>(y * width + x)]);
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            EXPECT_NEAR(std::atan2(d.z, d.x) / (2.0 * pi) + 0.5, u, 1e-6);   // three.js: equirectUv
            EXPECT_NEAR(0.5 - std::asin(d.y) / pi, v, 1e-5);                 // from the top
            const glm::dvec3 b(d.x, -d.z, d.y);                              // Blender's axes
            EXPECT_NEAR(-std::atan2(b.y, b.x) / (2.0 * pi) + 0.5, u, 1e-6);  // Cycles: equirectangular
        }
    }
    EXPECT_NEAR(sum, 4.0 * pi, 1e-12);
}

TEST(Panorama, ReadsItsPixels) {
    Panorama panorama{4, 2, {}};
    for (int i = 0; i < 8; ++i) panorama.pixels.emplace_back(static_cast<float>(i));
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_NEAR(panorama.at(panorama.direction(x + 0.5, y + 0.5)).x, static_cast<float>(4 * y + x), 1e-5F);
    EXPECT_NEAR(panorama.at(panorama.direction(0.0, 0.5)).x, 1.5F, 1e-5F);  // between the last and the first column
}

}  // namespace
}  // namespace lumulus::prefilter
