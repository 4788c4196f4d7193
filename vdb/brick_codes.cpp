#include "vdb/brick_codes.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lumulus::vdb {
namespace {

float halfUp(float value) {
    std::uint16_t bits = imath_float_to_half(value);
    if (imath_half_to_float(bits) < value) ++bits;
    return imath_half_to_float(bits);
}

float halfDown(float value) {
    std::uint16_t bits = imath_float_to_half(value);
    if (imath_half_to_float(bits) > value) --bits;
    return imath_half_to_float(bits);
}

}  // namespace

std::uint32_t packRange(const CodeRange& range) {
    return imath_float_to_half(range.low) | static_cast<std::uint32_t>(imath_float_to_half(range.span)) << 16U;
}

CodeRange unpackRange(std::uint32_t packed) {
    return {imath_half_to_float(static_cast<std::uint16_t>(packed)),
            imath_half_to_float(static_cast<std::uint16_t>(packed >> 16U))};
}

CodeRange encode(std::span<const float> values, DensityFormat format, std::span<std::byte> codes, CodeError& error) {
    const auto [least, most] = std::ranges::minmax_element(values);
    CodeRange range{0.0F, 1.0F};
    if (format == DensityFormat::r8) {
        range.low = halfDown(*least);
        range.span = std::max(halfUp(*most - range.low), 0x1p-24F);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float value = values[i];
        if (format == DensityFormat::r8) {
            const float code = std::round(255.0F * (value - range.low) / range.span);
            codes[i] = static_cast<std::byte>(std::clamp(code, 0.0F, 255.0F));
        } else {
            const std::uint16_t bits = imath_float_to_half(value);
            std::memcpy(&codes[2 * i], &bits, sizeof(bits));
        }
        const double stored = static_cast<double>(range.low + range.span * texelValue(codes, i, format));
        error.values += static_cast<double>(value);
        error.errors += std::abs(stored - static_cast<double>(value));
    }
    return range;
}

}  // namespace lumulus::vdb
