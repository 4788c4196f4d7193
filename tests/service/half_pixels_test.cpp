// Rounding to half: the fast way makes the bits of the plain one, which are Imath's.
#include "service/protocol/half_pixels.h"

#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace lumulus::service {
namespace {

/// Every half, the middle between it and the next, and the floats beside that middle: where rounding turns.
std::vector<float> turningPoints() {
    std::vector<float> values;
    for (std::uint32_t bits = 0; bits < 0x10000U; ++bits) {
        Imath::half half, next;
        half.setBits(static_cast<std::uint16_t>(bits));
        next.setBits(static_cast<std::uint16_t>(bits + 1U));
        values.push_back(half);
        if (!half.isFinite()) continue;
        // what lies beyond the largest half counts as 65536 here
        const float beyond = next.isFinite() ? static_cast<float>(next) : std::copysign(65536.0F, half);
        const float middle = 0.5F * (static_cast<float>(half) + beyond);
        values.push_back(middle);
        for (const float side : {-1.0F, 1.0F})
            values.push_back(std::nextafter(middle, side * std::numeric_limits<float>::infinity()));
    }
    return values;
}

/// Every exponent of a float, both signs, with mantissas around the bits that are cut off: denormals, infinities and
/// NaNs of all kinds among them.
std::vector<float> everyExponent() {
    std::vector<float> values;
    for (std::uint32_t top = 0; top < 512U; ++top)
        for (const std::uint32_t mantissa : {0U, 1U, 0xFFFU, 0x1000U, 0x1001U, 0x2FFFU, 0x3000U, 0x3001U, 0x200000U,
                                             0x3FFFFFU, 0x400000U, 0x400001U, 0x7FEFFFU, 0x7FF000U, 0x7FFFFFU})
            values.push_back(std::bit_cast<float>((top << 23U) | mantissa));
    return values;
}

std::vector<std::uint16_t> expected(const std::vector<const float*>& planes, std::size_t count) {
    std::vector<std::uint16_t> result;
    for (std::size_t i = 0; i < count; ++i)
        for (const float* plane : planes) result.push_back(Imath::half(plane[i]).bits());
    return result;
}

void expectSameBits(const std::vector<float>& values, std::size_t channels, std::size_t count) {
    std::vector<const float*> planes;
    for (std::size_t channel = 0; channel < channels; ++channel) planes.push_back(values.data() + channel);
    std::vector<std::uint16_t> made(channels * count + 1, 0xABCD);
    interleaveHalves(planes, count, reinterpret_cast<std::byte*>(made.data()));
    EXPECT_EQ(made.back(), 0xABCD) << "written beyond the end";
    made.pop_back();
    EXPECT_TRUE(made == expected(planes, count)) << channels << " channels, " << count << " pixels";
    interleaveHalvesPlainly(planes, count, reinterpret_cast<std::byte*>(made.data()));
    EXPECT_TRUE(made == expected(planes, count)) << channels << " channels, " << count << " pixels, plainly";
}

TEST(HalfPixels, RoundsAsImathDoesWhereverRoundingTurns) {
    const std::vector<float> values = turningPoints();
    ASSERT_GT(values.size(), 250000U);
    for (const std::size_t channels : {1U, 3U, 4U}) expectSameBits(values, channels, values.size() - channels);
}

TEST(HalfPixels, RoundsAsImathDoesWhateverTheFloat) {
    const std::vector<float> values = everyExponent();
    for (const std::size_t channels : {1U, 3U, 4U, 5U}) expectSameBits(values, channels, values.size() - channels);
}

TEST(HalfPixels, TakesAnyNumberOfPixels) {
    const std::vector<float> values = turningPoints();
    for (std::size_t count = 0; count < 40; ++count) expectSameBits(values, 3, count);
}

}  // namespace
}  // namespace lumulus::service
