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
    return static_cast<std::uint8_t>(value * 255.0F + 0.5F);
}
double fromByte(std::uint8_t texel) {
    return texel / 255.0;
}

std::uint16_t toHalf(float value) {
    return imath_float_to_half(value);
}
double fromHalf(std::uint16_t texel) {
    return static_cast<double>(imath_half_to_float(texel));
}

float toFloat(float value) {
    return value;
}
double fromFloat(float texel) {
    return static_cast<double>(texel);
}

struct Sums {
    double values = 0.0;  ///< Σ v, v = density / maximum
    double errors = 0.0;  ///< Σ|q − v|
};

/// Σ|q − v| / Σ v. The order of the sums is fixed, so that the choice of the format does not depend on threads.
template <typename To, typename From>
double measureError(const Volume& volume, const To& to, const From& from, const Check& check) {
    using Range = tbb::blocked_range<std::size_t>;
    const double scale = 1.0 / static_cast<double>(volume.maximum);
    const Sums sums = tbb::parallel_deterministic_reduce(
        Range(0, volume.density.size(), kGrain), Sums{},
        [&](const Range& range, Sums part) {
            check();
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                const float density = volume.density[i];
                if (density == 0.0F) continue;
                const double exact = static_cast<double>(density) * scale;
                part.values += exact;
                part.errors += std::abs(from(to(density / volume.maximum)) - exact);
            }
            return part;
        },
        [](const Sums& a, const Sums& b) {
            return Sums{a.values + b.values, a.errors + b.errors};
        });
    return sums.errors / sums.values;
}

template <typename Texel, typename Convert>
std::vector<std::byte> store(const Volume& volume, const Convert& convert, const Check& check) {
    std::vector<std::byte> texels(volume.density.size() * sizeof(Texel));
    if (volume.empty()) return texels;
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, volume.density.size(), kGrain), [&](const Range& range) {
        check();
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const Texel texel = convert(volume.density[i] / volume.maximum);
            std::memcpy(texels.data() + i * sizeof(Texel), &texel, sizeof(Texel));
        }
    });
    return texels;
}

}  // namespace

float texelValue(std::span<const std::byte> texels, std::size_t place, DensityFormat format) {
    if (format == DensityFormat::r8) return static_cast<float>(texels[place]) / 255.0F;
    if (format == DensityFormat::r32f) {
        float value = 0.0F;
        std::memcpy(&value, &texels[4 * place], sizeof(value));
        return value;
    }
    std::uint16_t bits = 0;
    std::memcpy(&bits, &texels[2 * place], sizeof(bits));
    return imath_half_to_float(bits);
}

std::size_t texelBytes(DensityFormat format) {
    return format == DensityFormat::r8 ? 1 : format == DensityFormat::r16f ? 2 : 4;
}

QuantisedVolume quantise(const Volume& volume, const Check& check) {
    if (volume.empty()) return {DensityFormat::r8, store<std::uint8_t>(volume, toByte, check), 0.0};
    if (const double error = measureError(volume, toByte, fromByte, check); error <= kTolerance) {
        return {DensityFormat::r8, store<std::uint8_t>(volume, toByte, check), error};
    }
    if (const double error = measureError(volume, toHalf, fromHalf, check); error <= kTolerance) {
        return {DensityFormat::r16f, store<std::uint16_t>(volume, toHalf, check), error};
    }
    return {DensityFormat::r32f, store<float>(volume, toFloat, check), measureError(volume, toFloat, fromFloat, check)};
}

}  // namespace lumulus::vdb
