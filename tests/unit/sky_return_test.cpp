// Light of the sky that a backward peak sends to and fro along lines of sight.
#include "light/photon/sky_return.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "medium/scattering_tables.h"
#include "shared/sky_return.h"

namespace lumulus::photon {
namespace {

using std::numbers::pi;

constexpr int rows = shared::SKY_RETURN_ROWS, columns = shared::SKY_RETURN_COLUMNS, depths = shared::SKY_RETURN_DEPTHS;

phase::ScatteringMedium backward(double g, double albedo = 1.0) {
    const glm::dvec3 grey(albedo);
    return {
        0.1, grey,
        phase::makeScatteringTables({scene::PhaseModel::henyeyGreenstein, g, 20.0}, 15.0 * pi / 180.0, grey, 4, 0.0)};
}

/// A sky by direction, in cells of a degree.
AirLight skyOf(const std::function<double(const glm::dvec3&)>& radiance) {
    AirLight air;
    air.skyFrame.size = {360, 180};
    air.skyFlux = glm::dvec3(1.0);
    for (int cell = 0; cell < air.skyFrame.count(); ++cell) {
        // what a photon weighs that starts in each cell as often as in the others
        const glm::vec3 weight(static_cast<float>(radiance(air.skyFrame.direction(cell, {0.5, 0.5})) *
                                                  air.skyFrame.count() * air.skyFrame.solidAngle(cell)));
        air.cells.push_back({1.0F, static_cast<std::uint32_t>(cell), weight, weight});
    }
    return air;
}

struct Texel {
    int level, row, column;
};

double valueAt(const SkyReturn& sky, const Texel& at) {
    return static_cast<double>(
        sky.texels[static_cast<std::size_t>((at.level * rows + at.row) * (columns + 1) + at.column)].g);
}

double depthOf(int level) {
    return level / (depths - 1.0 - level);
}

/// What two streams of a layer send back and let through, by small steps through it: the light that comes from both
/// sides of a layer that grows.
struct Layer {
    double reflected = 0.0, passed = 1.0;
};

Layer layerOf(double share, double depth) {
    constexpr int steps = 20000;
    Layer layer;
    const double step = depth / steps;
    for (int i = 0; i < steps; ++i) {  // invariant embedding (Chandrasekhar 1960, § 52)
        const double middle =
            layer.reflected + 0.5 * step * (share - 2.0 * layer.reflected + share * layer.reflected * layer.reflected);
        layer.passed *= std::exp(step * (share * middle - 1.0));
        layer.reflected += step * (share - 2.0 * middle + share * middle * middle);
    }
    return layer;
}

TEST(SkyReturn, OnlyBackwardPeaksReturnTheSky) {
    EXPECT_TRUE(returnsSky(backward(-0.95)));
    for (const double g : {-0.3, 0.0, 0.85}) EXPECT_FALSE(returnsSky(backward(g))) << g;
}

TEST(SkyReturn, TheBandsOfCollectorsAreLeftToThem) {
    // 1 + x + xy has the bands 0 to 2
    const AirLight sky = skyOf([](const glm::dvec3& d) { return 1.0 + d.x + d.x * d.y; });
    const SkyReturn none = makeSkyReturn(sky, backward(-0.99));
    EXPECT_EQ(none.texels.size(), static_cast<std::size_t>((columns + 1) * rows * depths));
    for (const glm::vec4& texel : none.texels) EXPECT_NEAR(texel.g, 0.0F, 3e-3F);
}

/// Each band is sent back and let through as by a layer of its own, with the sign that it has on the other side.
TEST(SkyReturn, ABandIsThatOfTwoStreams) {
    for (const unsigned band : {5U, 6U, 13U})
        for (const double albedo : {1.0, 0.9}) {
            const AirLight sky = skyOf([&](const glm::dvec3& d) { return 1.0 + std::legendre(band, d.y); });
            const SkyReturn made = makeSkyReturn(sky, backward(-0.95, albedo));
            for (const int level : {0, 3, 8, 12})
                for (const int row : {0, 11, 31, 32, 50}) {
                    const Layer layer = layerOf(albedo * std::pow(0.95, band), depthOf(level));
                    const double along = std::legendre(band, std::cos(pi * (row + 0.5) / rows));
                    const double sign = band % 2 == 0 ? 1.0 : -1.0;
                    const double expected = along * (sign * layer.reflected + layer.passed - std::exp(-depthOf(level)));
                    EXPECT_NEAR(valueAt(made, {level, row, 17}), expected, 2e-3) << band << " " << level << " " << row;
                }
        }
}

/// A bright spot is seen where its light comes straight back, and beside it as dark as before.
TEST(SkyReturn, ABrightSpotComesBack) {
    const glm::dvec3 spot = glm::normalize(glm::dvec3(0.3, 0.2, -0.9));
    const AirLight sky = skyOf([&](const glm::dvec3& d) { return std::exp(-40.0 * (1.0 - glm::dot(d, spot))); });
    const SkyReturn made = makeSkyReturn(sky, backward(-0.99));
    double most = 0.0;
    glm::dvec3 where(0.0);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double down = pi * (row + 0.5) / rows, azimuth = 2.0 * pi * column / columns;
            if (const double value = valueAt(made, {8, row, column}); value > most) {
                most = value;
                where = {std::sin(down) * std::cos(azimuth), std::cos(down), std::sin(down) * std::sin(azimuth)};
            }
        }
    EXPECT_LT(glm::dot(where, spot), -0.99) << "looking away from it";
    EXPECT_GT(most, 0.2);
}

/// All round the azimuth, the last column is the first one.
TEST(SkyReturn, TheAzimuthGoesRound) {
    const SkyReturn made =
        makeSkyReturn(skyOf([](const glm::dvec3& d) { return std::exp(3.0 * d.x + d.y); }), backward(-0.9));
    for (int level = 0; level < depths; ++level)
        for (int row = 0; row < rows; ++row)
            EXPECT_NEAR(valueAt(made, {level, row, 0}), valueAt(made, {level, row, columns}), 1e-5);
}

}  // namespace
}  // namespace lumulus::photon
