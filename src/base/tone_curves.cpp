#include "base/tone_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lumulus {
namespace {

using Matrix = std::array<Colour, 3>;  ///< rows

Colour times(const Matrix& m, const Colour& c) {
    Colour result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2];
    return result;
}

/// From linear sRGB to the primaries of AgX and back.
constexpr Matrix agxInset{{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                           {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                           {0.0423756549057051, 0.0784336, 0.879142973793104}}};
constexpr Matrix agxOutset{{{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                            {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                            {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}};
constexpr double agxDarkest = -12.47393, agxBrightest = 4.026069;  // log2 of radiance

/// The contrast curve of AgX on [0,1].
double agxContrast(double x) {
    const double x2 = x * x, x4 = x2 * x2;
    return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
}

/// sRGB to ACEScg and to the saturation of the rendering transform; the way back to sRGB.
constexpr Matrix acesIn{{{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}}};
constexpr Matrix acesOut{{{1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}}};

constexpr double brightest = 1e6;  // the squares of larger values are not needed: every curve is flat there

double sane(double radiance) {
    return radiance > 0.0 ? std::min(radiance, brightest) : 0.0;  // 0 for what is no number too
}

Colour encodedLinear(Colour linear) {
    for (double& c : linear) c = srgbEncoded(std::clamp(c, 0.0, 1.0));
    return linear;
}

}  // namespace

double filmicCurve(double radiance) {
    const double x = std::min(radiance, brightest);
    return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

Colour acesCurve(const Colour& radiance) {
    Colour c = times(acesIn, radiance);
    for (double& v : c) v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    c = times(acesOut, c);
    for (double& v : c) v = std::clamp(v, 0.0, 1.0);
    return c;
}

Colour neutralCurve(const Colour& radiance) {
    constexpr double start = 0.8 - 0.04, desaturation = 0.15;
    const double least = std::min({radiance[0], radiance[1], radiance[2]});
    const double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    Colour c = radiance;
    for (double& v : c) v -= offset;
    const double peak = std::max({c[0], c[1], c[2]});
    if (peak < start) return c;
    constexpr double room = 1.0 - start;
    const double compressed = 1.0 - room * room / (peak + room - start);
    const double kept = 1.0 / (desaturation * (peak - compressed) + 1.0);
    for (double& v : c) v = v * (compressed / peak) * kept + compressed * (1.0 - kept);
    return c;
}

Colour agxEncoded(const Colour& radiance) {
    Colour c = times(agxInset, radiance);
    for (double& v : c) {
        const double stops = std::clamp(std::log2(std::max(v, 1e-10)), agxDarkest, agxBrightest);
        v = agxContrast((stops - agxDarkest) / (agxBrightest - agxDarkest));
    }
    c = times(agxOutset, c);
    for (double& v : c) v = std::clamp(v, 0.0, 1.0);
    return c;
}

double srgbEncoded(double linear) {
    if (linear >= 1.0) return 1.0;  // exactly: rounding would dither white
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

Colour displayed(ToneCurve curve, const Colour& radiance) {
    const Colour c{sane(radiance[0]), sane(radiance[1]), sane(radiance[2])};
    switch (curve) {
        case ToneCurve::filmic:
            return encodedLinear({filmicCurve(c[0]), filmicCurve(c[1]), filmicCurve(c[2])});
        case ToneCurve::agx:
            return agxEncoded(c);
        case ToneCurve::aces:
            return encodedLinear(acesCurve(c));
        case ToneCurve::neutral:
            return encodedLinear(neutralCurve(c));
        case ToneCurve::linear:
            break;
    }
    return encodedLinear(c);
}

}  // namespace lumulus
