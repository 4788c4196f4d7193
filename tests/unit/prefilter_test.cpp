#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "bench/texel_sum.h"
#include "prefilter/brdf_table.h"
#include "prefilter/cone.h"
#include "prefilter/layouts.h"
#include "prefilter/prefilter.h"

namespace lumulus::prefilter {
namespace {

const Check goOn = [] {};

Panorama uniform(int width, int height, const glm::vec3& value) {
    return {width, height, std::vector<glm::vec3>(static_cast<std::size_t>(width * height), value)};
}

/// A sky that is white is white for every surface.
TEST(Prefilter, WhiteStaysWhite) {
    const Panorama white = uniform(64, 32, glm::vec3(1.0F, 2.0F, 0.5F));
    const CubeMap cube(white, 32, goOn);
    const std::vector<glm::vec3> directions = bench::evenDirections(50);
    std::vector<std::vector<glm::vec3>> all;
    for (const double alpha : {0.0, 1e-5, 0.01, 0.1, 0.5, 1.0})
        all.push_back(filtered(cube, ggxLobe(alpha, 32, 0.1), directions, goOn));
    for (const ConeLevel& level : coneLevels) all.push_back(coneMeans(cube, level.angle, directions, goOn));
    for (const std::vector<glm::vec3>& values : all)
        for (const glm::vec3& value : values) {
            EXPECT_NEAR(value.r, 1.0F, 1e-5F);
            EXPECT_NEAR(value.g, 2.0F, 2e-5F);
            EXPECT_NEAR(value.b, 0.5F, 1e-5F);
        }
}

/// Against the sum over all texels, on a clear sky at a low sun whose disc is apart: 2 % for every roughness, at pixels
/// and between them.
TEST(Prefilter, ClearSkyIsThatOfTheTexelSum) {
    const Panorama sky = bench::clearSky(12.0, 128);
    constexpr int size = 128;
    const CubeMap cube(sky, size, goOn);
    const std::vector<glm::vec3> directions = bench::evenDirections(150);
    for (const auto& [roughness, edge] :
         {std::pair{0.25, 64}, std::pair{0.5, 64}, std::pair{0.75, 32}, std::pair{1.0, 16}}) {
        const double alpha = roughness * roughness;
        const std::vector<glm::vec3> truth = bench::texelSum(sky, alpha, directions);
        const Lobe lobe = ggxLobe(alpha, size, 0.0);
        EXPECT_LT(bench::relativeError(filtered(cube, lobe, directions, goOn), truth), 0.01) << roughness;
        const std::vector<glm::vec3> pixels = filtered(cube, lobe, openExrCube(edge), goOn);
        std::vector<glm::vec3> read;
        for (const glm::vec3& direction : directions) read.push_back(bench::readCube(pixels, edge, direction));
        EXPECT_LT(bench::relativeError(read, truth), 0.02) << roughness;
    }
}

/// A cosine over the sphere, 1 + y, has the mean 1 + m y over a lobe, m the mean cosine of its weights.
TEST(Prefilter, GradientKeepsItsMeanCosine) {
    Panorama sky = uniform(256, 128, glm::vec3(0.0F));
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            sky.pixels[static_cast<std::size_t>(y * sky.width + x)] =
                glm::vec3(static_cast<float>(1.0 + sky.direction(x + 0.5, y + 0.5).y));
    const CubeMap cube(sky, 64, goOn);
    for (const double alpha : {0.04, 0.3, 1.0}) {
        double mean = 0.0, weights = 0.0;  // by the density of the light, D / 4, times its cosine
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double c = (i + 0.5) / steps, half = 0.5 * (1.0 + c);  // (n·h)²
            const double weight = c / std::pow(1.0 - half + alpha * alpha * half, 2);
            mean += weight * c;
            weights += weight;
        }
        mean /= weights;
        const std::vector<glm::vec3> directions = bench::evenDirections(40);
        const std::vector<glm::vec3> values = filtered(cube, ggxLobe(alpha, 64, 0.0), directions, goOn);
        for (std::size_t i = 0; i < values.size(); ++i)
            EXPECT_NEAR(values[i].x, 1.0 + mean * directions[i].y, 0.006) << alpha;
    }
}

TEST(Prefilter, NumbersThatAreNoRadianceBecomeDark) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const std::vector<float> bad{nan, infinite, -1.0F, 3.0F};
    const Panorama panorama = panoramaOf(4, 1, bad, bad, bad);
    EXPECT_EQ(panorama.pixels[0], glm::vec3(0.0F));
    EXPECT_EQ(panorama.pixels[1], glm::vec3(0.0F));
    EXPECT_EQ(panorama.pixels[2], glm::vec3(0.0F));
    EXPECT_EQ(panorama.pixels[3], glm::vec3(3.0F));
}

TEST(Prefilter, MapsOfOneTexel) {
    const Panorama one = uniform(1, 1, glm::vec3(7.0F));
    for (const int size : {1, 2}) {
        const CubeMap cube(one, size, goOn);
        EXPECT_EQ(cube.levels(), size);
        for (const double alpha : {0.0, 0.5, 1.0})
            for (const glm::vec3& value : filtered(cube, ggxLobe(alpha, size, 100.0), bench::evenDirections(20), goOn))
                EXPECT_NEAR(value.x, 7.0F, 1e-5F);
    }
    EXPECT_NEAR(coneMeans(CubeMap(one, 1, goOn), 65.0, bench::evenDirections(1), goOn).front().x, 7.0F, 1e-5F);
}

/// Work can be ended between its parts.
TEST(Prefilter, Stops) {
    const Panorama white = uniform(64, 32, glm::vec3(1.0F));
    const CubeMap cube(white, 8, goOn);
    const Check stop = [] { throw std::runtime_error("stop"); };
    const std::vector<glm::vec3> directions = bench::evenDirections(1000);
    EXPECT_THROW(CubeMap(white, 8, stop), std::runtime_error);
    EXPECT_THROW(filtered(cube, ggxLobe(0.5, 8, 0.0), directions, stop), std::runtime_error);
    EXPECT_THROW(coneMeans(cube, 10.0, directions, stop), std::runtime_error);
    EXPECT_THROW(brdfTable(BrdfModel::ggx, 8, stop), std::runtime_error);
}

/// A map reads the same on both sides of an edge, and its texels keep the sum of the light.
TEST(CubeMap, EdgesAndMeans) {
    const Panorama sky = bench::clearSky(50.0, 32);
    const CubeMap cube(sky, 32, goOn);
    for (int i = 0; i < 40; ++i) {
        const double along = 0.05 * i - 0.975;
        const glm::vec3 before = glm::normalize(glm::vec3(1.0, along, 0.9999)),
                        behind = glm::normalize(glm::vec3(0.9999, along, 1.0));
        const glm::vec3 a = cube.at(before, 0.0F), b = cube.at(behind, 0.0F);
        EXPECT_NEAR(a.g, b.g, 0.02F * a.g) << along;
    }
    glm::dvec3 sum(0.0);
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            sum += sky.solidAngle(y) * glm::dvec3(sky.pixels[static_cast<std::size_t>(y * sky.width + x)]);
    glm::dvec3 faces(0.0);
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0F, 1.0F}) {
            glm::vec3 direction(0.0F);
            direction[axis] = sign;
            faces += glm::dvec3(cube.at(direction, 10.0F)) / 6.0;
        }
    EXPECT_NEAR(faces.g, sum.g / (4.0 * std::numbers::pi), 0.01 * faces.g);
}

TEST(BrdfTable, EnergyAndMirrors) {
    const LayeredImage table = brdfTable(BrdfModel::ggx, 16, goOn);
    const auto energy = [&](std::size_t x, std::size_t y) {
        return table.layers.at("R")[16 * y + x] + table.layers.at("G")[16 * y + x];
    };
    for (std::size_t x = 1; x < 16; ++x) EXPECT_NEAR(energy(x, 0), 1.0F, 0.01F);  // hardly rough
    EXPECT_LT(energy(15, 15), 0.6F);
    EXPECT_GT(energy(15, 15), 0.3F);
}

}  // namespace
}  // namespace lumulus::prefilter
