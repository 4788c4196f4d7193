#include "service/protocol/half_pixels.h"

#include <half.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace lumulus::service {

void interleaveHalvesPlainly(std::span<const float* const> planes, std::size_t count, std::byte* out) {
    for (std::size_t i = 0; i < count; ++i)
        for (const float* plane : planes) {
            const std::uint16_t bits = Imath::half(plane[i]).bits();
            std::memcpy(out, &bits, sizeof(bits));
            out += sizeof(bits);
        }
}

#ifdef __x86_64__

namespace {

constexpr std::size_t lanes = 8;
constexpr std::size_t channels = 4;

/// Eight pixels of four planes. False where one of them is no number: the instruction changes signalling NaNs.
__attribute__((target("avx,f16c"))) bool interleaveEight(const float* const* planes, std::size_t first,
                                                         std::byte* out) {
    __m128i halves[channels];
    int strange = 0;
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const __m256 values = _mm256_loadu_ps(planes[channel] + first);
        strange |= _mm256_movemask_ps(_mm256_cmp_ps(values, values, _CMP_UNORD_Q));
        halves[channel] = _mm256_cvtps_ph(values, _MM_FROUND_TO_NEAREST_INT);
    }
    if (strange != 0) return false;
    const __m128i redGreen[2] = {_mm_unpacklo_epi16(halves[0], halves[1]), _mm_unpackhi_epi16(halves[0], halves[1])};
    const __m128i blueAlpha[2] = {_mm_unpacklo_epi16(halves[2], halves[3]), _mm_unpackhi_epi16(halves[2], halves[3])};
    for (int part = 0; part < 2; ++part) {
        auto* to = reinterpret_cast<__m128i*>(out) + 2 * part;
        _mm_storeu_si128(to, _mm_unpacklo_epi32(redGreen[part], blueAlpha[part]));
        _mm_storeu_si128(to + 1, _mm_unpackhi_epi32(redGreen[part], blueAlpha[part]));
    }
    return true;
}

/// Any number of planes: what is not four is filled up, and cut off again.
void interleaveFast(std::span<const float* const> planes, std::size_t count, std::byte* out) {
    const std::size_t used = planes.size(), pixelBytes = used * sizeof(std::uint16_t);
    const float* four[channels];
    for (std::size_t channel = 0; channel < channels; ++channel) four[channel] = planes[std::min(channel, used - 1)];
    std::byte block[lanes * channels * sizeof(std::uint16_t)];
    const std::size_t whole = count / lanes * lanes;
    for (std::size_t first = 0; first < whole; first += lanes) {
        std::byte* to = out + first * pixelBytes;
        if (!interleaveEight(four, first, used == channels ? to : block)) {
            std::vector<const float*> from(planes.begin(), planes.end());
            for (const float*& plane : from) plane += first;
            interleaveHalvesPlainly(from, lanes, to);
        } else if (used != channels) {
            for (std::size_t i = 0; i < lanes; ++i)
                std::memcpy(to + i * pixelBytes, block + i * channels * sizeof(std::uint16_t), pixelBytes);
        }
    }
    std::vector<const float*> rest(planes.begin(), planes.end());
    for (const float*& plane : rest) plane += whole;
    interleaveHalvesPlainly(rest, count - whole, out + whole * pixelBytes);
}

}  // namespace

void interleaveHalves(std::span<const float* const> planes, std::size_t count, std::byte* out) {
    static const bool able = __builtin_cpu_supports("avx") != 0 && __builtin_cpu_supports("f16c") != 0;
    if (able && planes.size() <= channels)
        interleaveFast(planes, count, out);
    else
        interleaveHalvesPlainly(planes, count, out);
}

#else

void interleaveHalves(std::span<const float* const> planes, std::size_t count, std::byte* out) {
    interleaveHalvesPlainly(planes, count, out);
}

#endif

}  // namespace lumulus::service
