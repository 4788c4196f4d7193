// What frames are made of: costs foreseen, pictures enlarged, noise estimated, pixels encoded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "service/protocol/encode.h"
#include "service/render/cost_model.h"
#include "service/render/noise.h"
#include "service/render/resample.h"
#include "service/render/viewed_light.h"

namespace lumulus::service {
namespace {

LayeredImage picture(int width, int height, float (*value)(int, int)) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    for (const char* name : {"R", "G", "B", "A", "cloud.R", "cloud.G", "cloud.B", "cloud.A", "transmittance.R",
                             "transmittance.G", "transmittance.B", "depth.Z", "depth.front"}) {
        std::vector<float>& layer = image.layer(name);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) layer[static_cast<std::size_t>(y * width + x)] = value(x, y);
    }
    return image;
}

TEST(CostModel, ForeseesWhatItHasSeen) {
    CostModel costs;
    costs.drawn({1, 1, 100'000, 0}, {10.0, 100.0, 0.0, 113.0});  // 3 ms for a view
    EXPECT_DOUBLE_EQ(costs.drawMs({1, 1, 200'000, 0}), 213.0);
    EXPECT_DOUBLE_EQ(costs.drawMs({2, 1, 100'000, 0}), 116.0);
    EXPECT_DOUBLE_EQ(costs.drawMs({1, 0, 100'000, 0}), 103.0) << "the eye is where it was";
    costs.drawn({1, 0, 25'000, 100'000}, {0.0, 25.0, 2.0, 30.0});
    EXPECT_DOUBLE_EQ(costs.drawMs({1, 1, 25'000, 50'000}), 39.0);
    costs.encoded(Encoding::jpeg, 20.0, 100'000);
    EXPECT_DOUBLE_EQ(costs.encodeMs(Encoding::jpeg, 50'000), 10.0);
    EXPECT_EQ(costs.encodeMs(Encoding::exr, 50'000), 0.0);
    for (int i = 0; i < 60; ++i) costs.traced(50.0);
    EXPECT_DOUBLE_EQ(costs.traceMs(), 50.0);
}

/// The light of reduced pictures is coarse.
TEST(CostModel, KnowsReducedPicturesByThemselves) {
    CostModel costs;
    costs.drawn({1, 1, 100'000, 0}, {10.0, 100.0, 0.0, 113.0});
    CostModel::Work work{2, 2, 100'000, 0, 3};
    EXPECT_DOUBLE_EQ(costs.drawMs(work), 126.0);
    work = CostModel::reduced(work, 2, 100'000);
    EXPECT_DOUBLE_EQ(costs.drawMs(work), 25.0 + 3 * 10.0 + 2 * 3.0) << "not known yet: as whole ones";
    costs.drawn({2, 2, 25'000, 100'000}, {4.0, 25.0, 2.0, 33.0});  // 2 ms of light, 1 ms for a view
    EXPECT_DOUBLE_EQ(costs.drawMs(work), 25.0 + 3 * 2.0 + 2 * 1.0 + 2.0);
    EXPECT_DOUBLE_EQ(costs.drawMs({2, 2, 100'000, 0}), 126.0) << "whole ones cost what they did";
}

TEST(CostModel, OneSlowFrameIsNotTheRule) {
    CostModel costs;
    for (const double milliseconds : {20.0, 21.0, 900.0}) costs.traced(milliseconds);
    EXPECT_DOUBLE_EQ(costs.traceMs(), 450.0) << "it may be";
    for (const double milliseconds : {22.0, 20.0}) costs.traced(milliseconds);
    EXPECT_DOUBLE_EQ(costs.traceMs(), 21.0);
    for (int i = 0; i < 3; ++i) costs.traced(60.0);
    EXPECT_DOUBLE_EQ(costs.traceMs(), 60.0) << "three are";
}

TEST(CostModel, ReducesAsFarAsTheDeadlineAsks) {
    CostModel costs;
    costs.drawn({1, 1, 100'000, 0}, {10.0, 400.0, 0.0, 410.0});  // 4 ms for 1000 rays
    const auto reduction = [&](double ms, std::uint64_t rays = 100'000) {
        return costs.reductionFor(ms, {1, 1, rays, 0}, 100'000, Encoding::half);
    };
    EXPECT_EQ(reduction(410.0), 1);
    EXPECT_EQ(reduction(409.0), 2);
    EXPECT_EQ(reduction(110.0), 2);
    EXPECT_EQ(reduction(60.0), 3);
    EXPECT_EQ(reduction(1.0), 8);
    EXPECT_EQ(reduction(-5.0), 8);
    // pixels larger than voxels have many rays: those go first
    EXPECT_EQ(reduction(300.0, 1'600'000), 2);
    costs.drawn({1, 1, 25'000, 100'000}, {10.0, 100.0, 20.0, 130.0});
    EXPECT_EQ(reduction(129.0), 3) << "enlarging takes its time too";
}

TEST(ViewedLight, IsMadeForEachEyeThatIsNew) {
    const Bounds clouds{glm::dvec3(0.0), glm::dmat3(1.0), {}};
    const auto from = [](double x) {
        View view;
        view.camera.position = glm::dvec3(x, 0.0, 9.0);
        view.camera.target = glm::dvec3(0.0);
        view.image = {16, 9, 0.0};
        return view;
    };
    View wide = from(1.0);
    wide.camera.verticalFov = 90.0;
    ViewedLight light;
    EXPECT_EQ(light.missing({from(1.0), wide, from(2.0)}, clouds, 0.0), 2U);
    light.drawn({from(2.0), from(1.0)}, clouds, 0.0);
    EXPECT_EQ(light.missing({wide, wide}, clouds, 0.0), 0U);
    EXPECT_EQ(light.missing({wide, from(2.0), wide}, clouds, 0.0), 2U);
    EXPECT_EQ(light.missing({wide}, clouds, 1.0), 1U) << "the wind moves the clouds";
    light.forget();
    EXPECT_EQ(light.missing({wide}, clouds, 0.0), 1U);
}

TEST(Resample, ALinearPictureStaysLinear) {
    View view;
    view.image = {40, 20, 0.0};
    const View small = reducedView(view, 4);
    EXPECT_EQ(small.image.width, 10);
    const LayeredImage large = enlarged(picture(10, 5, [](int x, int) { return static_cast<float>(x); }), view, small);
    ASSERT_EQ(large.width, 40);
    ASSERT_EQ(large.height, 20);
    for (int x = 2; x < 38; ++x)
        EXPECT_NEAR(large.layers.at("R")[static_cast<std::size_t>(5 * 40 + x)],
                    (static_cast<float>(x) + 0.5F) / 4.0F - 0.5F, 1e-5F);
    // depths are never mixed
    for (const float depth : large.layers.at("depth.Z")) EXPECT_EQ(depth, std::round(depth));
}

TEST(Resample, ATileOfASmallPictureCoversIt) {
    View view;
    view.image = {41, 23, 0.0};
    for (const Tile& tile : {Tile{0, 0, 41, 23}, Tile{40, 22, 1, 1}, Tile{7, 3, 13, 11}}) {
        view.tile = tile;
        for (const int reduction : CostModel::reductions) {
            const View small = reducedView(view, reduction);
            const Tile part = drawnTile(small);
            const LayeredImage large =
                enlarged(picture(part.width, part.height, [](int, int) { return 3.0F; }), view, small);
            EXPECT_EQ(large.width, tile.width);
            EXPECT_EQ(large.height, tile.height);
            for (const float value : large.layers.at("G")) ASSERT_NEAR(value, 3.0F, 1e-6F);
        }
    }
}

/// Means of 4 and of 16 draws with a known variance.
TEST(Noise, IsTheVarianceOfTheLaterMean) {
    constexpr double mean = 2.0, sigma = 0.3;
    std::mt19937 random(7);
    std::normal_distribution<double> draw(mean, sigma);
    LayeredImage four = picture(100, 100, [](int, int) { return 1.0F; });
    LayeredImage sixteen = four;
    for (const char* name : {"R", "G", "B"})
        for (std::size_t i = 0; i < four.pixels(); ++i) {
            double sum = 0.0;
            for (int n = 0; n < 16; ++n) {
                sum += draw(random);
                if (n == 3) four.layers[name][i] = static_cast<float>(sum / 4);
            }
            sixteen.layers[name][i] = static_cast<float>(sum / 16);
        }
    const double expected = sigma * sigma / 16 / (mean * mean + 0.01 * mean * mean);
    // 30 000 samples of a chi-square: 0.8 % standard error
    EXPECT_NEAR(nestedNoise(four, 4, sixteen, 16) / expected, 1.0, 0.04);
    EXPECT_EQ(nestedNoise(sixteen, 4, sixteen, 16), 0.0);
    for (float& alpha : sixteen.layers["cloud.A"]) alpha = 0.0F;
    EXPECT_EQ(nestedNoise(four, 4, sixteen, 16), 0.0);
}

TEST(Encode, HalvesRoundToNearestEvenAndDepthsAreFloats) {
    const LayeredImage image =
        picture(3, 2, [](int x, int y) { return x == 2 ? 1e10F : 1.0F + 0x1p-11F * static_cast<float>(x + 2 * y); });
    EncodedPictures pictures;
    pictures.payload.resize(5);
    appendPicture(image, {{Product::color, Product::depth}, {}, 0.0}, pictures);
    const std::vector<std::byte>& payload = pictures.payload;
    const auto& view = pictures.views[0];
    EXPECT_EQ(pictures.pixels, 6U);
    ASSERT_EQ(view["products"].size(), 2U);
    EXPECT_EQ(view["products"][0]["offset"], 5);
    EXPECT_EQ(view["products"][0]["bytes"], 3 * 2 * 4 * 2);
    EXPECT_EQ(view["products"][1]["type"], "float");
    EXPECT_EQ(view["products"][1]["bytes"], 3 * 2 * 4);
    const auto half = [&](std::size_t pixel) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, payload.data() + 5 + pixel * 8, 2);
        return bits;
    };
    EXPECT_EQ(half(0), 0x3C00);  // 1
    EXPECT_EQ(half(1), 0x3C00);  // 1 + half a step: to even
    EXPECT_EQ(half(2), 0x7C00);  // beyond 65504: infinity
    EXPECT_EQ(half(4), 0x3C02);  // 1 + a step and a half: to even
    float depth = 0.0F;
    std::memcpy(&depth, payload.data() + 5 + 48 + 2 * 4, 4);
    EXPECT_EQ(depth, 1e10F);
}

TEST(Encode, FilesBeginAsTheirKind) {
    const LayeredImage image = picture(16, 8, [](int x, int) { return static_cast<float>(x) / 16.0F; });
    const auto beginning = [&](Encoding encoding) {
        EncodedPictures pictures;
        PictureFormat format;
        format.encoding = encoding;
        appendPicture(image, {{Product::color}, format, 0.0}, pictures);
        EXPECT_EQ(pictures.views[0]["bytes"], pictures.payload.size());
        return std::string(reinterpret_cast<const char*>(pictures.payload.data()), 4);
    };
    EXPECT_EQ(beginning(Encoding::png), "\x89PNG");
    EXPECT_EQ(beginning(Encoding::jpeg).substr(0, 3), "\xFF\xD8\xFF");
    EXPECT_EQ(beginning(Encoding::exr), "\x76\x2f\x31\x01");
}

}  // namespace
}  // namespace lumulus::service
