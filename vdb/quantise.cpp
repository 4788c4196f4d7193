#include "vdb/quantise.h"

#include <Imath/half.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace lumulus::vdb {
namespace {

constexpr double kTolerance = 1e-3;
constexpr std::size_t kGrain = std::size_t{1} << 16;

std::uint8_t toByte(float value) {
    return static_cast<std::uint8_t>(std::nearbyint(value * 255.0F));
}

std::uint16_t toHalf(float value) {
    return imath_float_to_half(value);
}

/// Σ v and Σ|q − v| of each format, v = density / maximum.
struct Errors {
    double sum = 0.0, byte = 0.0, half = 0.0, single = 0.0;

    Errors operator+(const Errors& o) const { return {sum + o.sum, byte + o.byte, half + o.half, single + o.single}; }
};

/// The order of the sum is fixed, so that the choice of the format does not depend on threads.
Errors measure(const Volume& volume) {
    using Range = tbb::blocked_range<std::size_t>;
    return tbb::parallel_deterministic_reduce(
        Range(0, volume.density.size(), kGrain), Errors{},
        [&](const Range& range, Errors part) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                if (volume.density[i] == 0.0F) continue;
                const double exact = static_cast<double>(volume.density[i]) / volume.maximum;
                const float value = volume.density[i] / volume.maximum;
                part.sum += exact;
                part.byte += std::abs(toByte(value) / 255.0 - exact);
                part.half += std::abs(static_cast<double>(imath_half_to_float(toHalf(value))) - exact);
                part.single += std::abs(static_cast<double>(value) - exact);
            }
            return part;
        },
        [](const Errors& a, const Errors& b) { return a + b; });
}

template <typename Texel, typename Convert>
std::vector<std::byte> store(const Volume& volume, const Convert& convert) {
    std::vector<std::byte> texels(volume.density.size() * sizeof(Texel));
    if (volume.empty()) return texels;
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, volume.density.size(), kGrain), [&](const Range& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const Texel texel = convert(volume.density[i] / volume.maximum);
            std::memcpy(texels.data() + i * sizeof(Texel), &texel, sizeof(Texel));
        }
    });
    return texels;
}

}  // namespace

std::size_t texelBytes(DensityFormat format) {
    return format == DensityFormat::r8 ? 1 : format == DensityFormat::r16f ? 2 : 4;
}

QuantisedVolume quantise(const Volume& volume) {
    if (volume.empty()) return {DensityFormat::r8, store<std::uint8_t>(volume, toByte), 0.0};
    const Errors errors = measure(volume);
    if (errors.byte <= kTolerance * errors.sum) {
        return {DensityFormat::r8, store<std::uint8_t>(volume, toByte), errors.byte / errors.sum};
    }
    if (errors.half <= kTolerance * errors.sum) {
        return {DensityFormat::r16f, store<std::uint16_t>(volume, toHalf), errors.half / errors.sum};
    }
    return {DensityFormat::r32f, store<float>(volume, [](float v) { return v; }), errors.single / errors.sum};
}

}  // namespace lumulus::vdb
