#include "vdb/quantise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "vdb/procedural.h"

namespace lumulus::vdb {
namespace {

Volume makeLine(const std::vector<float>& values) {
    Volume volume;
    volume.size = {static_cast<int>(values.size()), 1, 1};
    volume.density = values;
    volume.maximum = *std::max_element(values.begin(), values.end());
    return volume;
}

template <typename Texel>
Texel texel(const QuantisedVolume& quantised, std::size_t i) {
    Texel value{};
    std::memcpy(&value, quantised.texels.data() + i * sizeof(Texel), sizeof(Texel));
    return value;
}

TEST(Quantise, BytesWhereTheySuffice) {
    const QuantisedVolume q = quantise(makeLine({0.0F, 3.0F, 1.0F, 2.0F}));  // thirds are whole 255ths
    EXPECT_EQ(q.format, DensityFormat::r8);
    ASSERT_EQ(q.texels.size(), 4U);
    EXPECT_EQ(texel<std::uint8_t>(q, 1), 255);
    EXPECT_EQ(texel<std::uint8_t>(q, 2), 85);
    EXPECT_LT(q.relativeError, 1e-7);
}

TEST(Quantise, HalvesRoundToNearestEven) {
    // 2^-11 above 1/2 lies halfway to the next step of 2^-11·½; the even neighbour wins; denormals are kept
    const float tie = 0.5F + 0x1p-12F;
    const float above = 0.5F + 3.0F * 0x1p-12F;
    const float denormal = 3.0F * 0x1p-24F;
    const float sixth = 1.0F / 6.0F;
    const QuantisedVolume q = quantise(makeLine({1.0F, tie, above, denormal, sixth, 0.0101F, 0.0137F}));
    ASSERT_EQ(q.format, DensityFormat::r16f);
    EXPECT_EQ(texel<std::uint16_t>(q, 0), 0x3c00);
    EXPECT_EQ(texel<std::uint16_t>(q, 1), 0x3800);
    EXPECT_EQ(texel<std::uint16_t>(q, 2), 0x3802);
    EXPECT_EQ(texel<std::uint16_t>(q, 3), 0x0003);
    EXPECT_EQ(texel<std::uint16_t>(q, 4), 0x3155);
    EXPECT_GT(q.relativeError, 0.0);
    EXPECT_LE(q.relativeError, 1e-3);
}

TEST(Quantise, ErrorIsTheMeasuredOne) {
    // bytes: 0.003 → 1/255, an error of 1/255 − 0.003 in a sum of 1.003
    const std::vector<float> values{1.0F, 0.003F};
    const QuantisedVolume q = quantise(makeLine(values));
    EXPECT_EQ(q.format, DensityFormat::r8);
    EXPECT_NEAR(q.relativeError, (1.0 / 255 - 0.003) / 1.003, 1e-8);
}

TEST(Quantise, SpikeNeedsFloats) {
    std::vector<float> values(4000000, 1.0F);
    for (std::size_t i = 0; i < values.size(); i += 2) values[i] = 1.3F;
    values[12345] = 1e6F;
    const QuantisedVolume q = quantise(makeLine(values));
    ASSERT_EQ(q.format, DensityFormat::r32f);
    EXPECT_EQ(q.texels.size(), values.size() * 4);
    EXPECT_EQ(texel<float>(q, 12345), 1.0F);
    EXPECT_EQ(texel<float>(q, 1), 1e-6F);
    EXPECT_LT(q.relativeError, 1e-7);
}

TEST(Quantise, EmptyVolumeIsZeros) {
    const QuantisedVolume q = quantise(makeLine({0.0F, 0.0F, 0.0F}));
    EXPECT_EQ(q.format, DensityFormat::r8);
    EXPECT_EQ(q.texels, std::vector<std::byte>(3, std::byte{0}));
    EXPECT_EQ(q.relativeError, 0.0);
}

TEST(Quantise, CumulusTakesAFewMilliseconds) {
    const Volume cloud = makeCloud({"cumulus", 96, 1});
    const auto start = std::chrono::steady_clock::now();
    const QuantisedVolume q = quantise(cloud);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    std::printf("%zu voxels in %.1f ms, error %.2e\n", cloud.density.size(), time.count(), q.relativeError);
    EXPECT_EQ(q.texels.size(), cloud.density.size() * texelBytes(q.format));
    EXPECT_LE(q.relativeError, 1e-3);
    EXPECT_LT(time.count(), 500.0);  // 3 ms on a quiet machine
}

}  // namespace
}  // namespace lumulus::vdb
