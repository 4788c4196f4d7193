#include "reference/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <numeric>

namespace lumulus::reference {
namespace {

using glm::dvec3;
using Plane = std::vector<double>;
using Kernel = std::vector<double>;  ///< odd length, centred

/// A colour picture as three planes.
struct Planes {
    std::array<Plane, 3> channel;
};

struct Size {
    int width;
    int height;
};

/// Linear Rec. 709 to CIE XYZ (columns are the primaries).
const glm::dmat3 toXyz(0.4123908, 0.2126390, 0.0193308, 0.3575843, 0.7151687, 0.1191948, 0.1804808, 0.0721923,
                       0.9505322);
/// The white of the display.
const dvec3 white = toXyz * dvec3(1.0);

double linear(std::uint8_t value) {
    const double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

/// The opponent space of the contrast sensitivity functions, YyCxCz.
dvec3 toOpponent(const dvec3& rgb) {
    const dvec3 n = toXyz * rgb / white;
    return {116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z)};
}

dvec3 fromOpponent(const dvec3& c) {
    const double y = (c.x + 16.0) / 116.0;
    return glm::inverse(toXyz) * (white * dvec3(y + c.y / 500.0, y, y - c.z / 200.0));
}

/// CIE L*a*b*, its chroma reduced with the lightness (Hunt's effect).
dvec3 toHuntLab(const dvec3& rgb) {
    const dvec3 n = toXyz * rgb / white;
    const auto f = [](double t) {
        constexpr double delta = 6.0 / 29.0;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const double lightness = 116.0 * f(n.y) - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (f(n.x) - f(n.y)), 0.01 * lightness * 200.0 * (f(n.y) - f(n.z))};
}

/// Abasi et al. 2020.
double hyAb(const dvec3& a, const dvec3& b) {
    const dvec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

Kernel gaussian(int radius, double sigma) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
    return kernel;
}

void scaleTo(Kernel& kernel, double sum) {
    const double factor = sum / std::accumulate(kernel.begin(), kernel.end(), 0.0);
    for (double& tap : kernel) tap *= factor;
}

/// Scales positive and negative taps apart, to sums of 1 and −1.
void balance(Kernel& kernel) {
    double positive = 0.0, negative = 0.0;
    for (const double tap : kernel) (tap > 0.0 ? positive : negative) += tap;
    for (double& tap : kernel) tap /= tap > 0.0 ? positive : -negative;
}

/// Convolution along one axis, edges continued.
Plane convolve(const Plane& plane, const Size& size, const Kernel& kernel, bool alongX) {
    const int radius = static_cast<int>(kernel.size() / 2);
    const int limit = (alongX ? size.width : size.height) - 1;
    Plane result(plane.size());
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            double sum = 0.0;
            for (int k = -radius; k <= radius; ++k) {
                const int at = std::clamp((alongX ? x : y) + k, 0, limit);
                const int from = alongX ? y * size.width + at : at * size.width + x;
                sum += kernel[static_cast<std::size_t>(k + radius)] * plane[static_cast<std::size_t>(from)];
            }
            result[static_cast<std::size_t>(y * size.width + x)] = sum;
        }
    }
    return result;
}

Plane convolve(const Plane& plane, const Size& size, const Kernel& across, const Kernel& down) {
    return convolve(convolve(plane, size, across, true), size, down, false);
}

/// One term a·√(π/b)·exp(−π²x²/b) of a contrast sensitivity in space, x in degrees.
struct SensitivityTerm {
    double a;
    double b;
};

/// Filters a channel with a sum of Gaussians, normalised as a whole; all channels use the widest term's radius.
Plane filterContrast(const Plane& plane, const Size& size, const std::vector<SensitivityTerm>& terms,
                     double perDegree) {
    constexpr double widest = 0.04;
    const int radius = static_cast<int>(
        std::ceil(3.0 * std::sqrt(widest / (2.0 * glm::pi<double>() * glm::pi<double>())) * perDegree));
    Plane result(plane.size(), 0.0);
    double total = 0.0;
    for (const auto& [a, b] : terms) {
        Kernel kernel = gaussian(radius, std::sqrt(b / 2.0) / glm::pi<double>() * perDegree);
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        const double weight = a * std::sqrt(glm::pi<double>() / b) * sum * sum;
        scaleTo(kernel, 1.0);
        const Plane part = convolve(plane, size, kernel, kernel);
        for (std::size_t i = 0; i < result.size(); ++i) result[i] += weight * part[i];
        total += weight;
    }
    for (double& value : result) value /= total;
    return result;
}

Planes opponentPlanes(std::span<const std::uint8_t> rgb) {
    Planes planes;
    for (Plane& plane : planes.channel) plane.resize(rgb.size() / 3);
    for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
        const dvec3 c = toOpponent({linear(rgb[3 * i]), linear(rgb[3 * i + 1]), linear(rgb[3 * i + 2])});
        for (std::size_t k = 0; k < 3; ++k) planes.channel[k][i] = c[static_cast<int>(k)];
    }
    return planes;
}

/// The picture as far as the eye resolves it, in L*a*b* with Hunt's effect.
std::vector<dvec3> perceived(const Planes& opponent, const Size& size, double perDegree) {
    const Plane y = filterContrast(opponent.channel[0], size, {{1.0, 0.0047}}, perDegree);
    const Plane x = filterContrast(opponent.channel[1], size, {{1.0, 0.0053}}, perDegree);
    const Plane z = filterContrast(opponent.channel[2], size, {{34.1, 0.04}, {13.5, 0.025}}, perDegree);
    std::vector<dvec3> result(y.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = toHuntLab(glm::clamp(fromOpponent({y[i], x[i], z[i]}), 0.0, 1.0));
    }
    return result;
}

/// Strength of edges and of points in the lightness, per pixel.
struct Features {
    Plane edges;
    Plane points;
};

Plane magnitude(const Plane& lightness, const Size& size, const Kernel& derivative, const Kernel& smooth) {
    const Plane x = convolve(lightness, size, derivative, smooth);
    const Plane y = convolve(lightness, size, smooth, derivative);
    Plane result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = std::hypot(x[i], y[i]);
    return result;
}

Features featuresOf(const Planes& opponent, const Size& size, double perDegree) {
    constexpr double featureWidth = 0.082;  // degrees
    const double sigma = 0.5 * featureWidth * perDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    Kernel smooth = gaussian(radius, sigma);
    Kernel first = smooth, second = smooth;
    for (int x = -radius; x <= radius; ++x) {
        const auto i = static_cast<std::size_t>(x + radius);
        first[i] *= -x;
        second[i] *= x * x / (sigma * sigma) - 1.0;
    }
    balance(first);
    balance(second);
    scaleTo(smooth, 1.0);
    Plane lightness = opponent.channel[0];
    for (double& value : lightness) value = (value + 16.0) / 116.0;
    return {magnitude(lightness, size, first, smooth), magnitude(lightness, size, second, smooth)};
}

/// The colour difference compressed to 0…1. Large differences, which the eye cannot rank, share the last 5 %.
double colourError(double difference, double largest) {
    constexpr double exponent = 0.7, knee = 0.4, kneeValue = 0.95;
    const double d = std::pow(difference, exponent), top = std::pow(largest, exponent);
    const double bend = knee * top;
    const double error = d < bend ? kneeValue / bend * d : kneeValue + (d - bend) / (top - bend) * (1.0 - kneeValue);
    return std::min(error, 1.0);
}

}  // namespace

std::vector<float> flip(std::span<const std::uint8_t> image, std::span<const std::uint8_t> reference, int width,
                        int height, double pixelsPerDegree) {
    assert(image.size() == reference.size() &&
           image.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const Size size{width, height};
    const Planes imagePlanes = opponentPlanes(image), referencePlanes = opponentPlanes(reference);
    const std::vector<dvec3> imageColours = perceived(imagePlanes, size, pixelsPerDegree);
    const std::vector<dvec3> referenceColours = perceived(referencePlanes, size, pixelsPerDegree);
    const Features imageFeatures = featuresOf(imagePlanes, size, pixelsPerDegree);
    const Features referenceFeatures = featuresOf(referencePlanes, size, pixelsPerDegree);
    const double largest = hyAb(toHuntLab({0.0, 1.0, 0.0}), toHuntLab({0.0, 0.0, 1.0}));
    std::vector<float> map(imageColours.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        const double colour = colourError(hyAb(imageColours[i], referenceColours[i]), largest);
        const double feature = std::max(std::abs(imageFeatures.edges[i] - referenceFeatures.edges[i]),
                                        std::abs(imageFeatures.points[i] - referenceFeatures.points[i]));
        const double featureError = std::min(1.0, std::sqrt(feature / glm::root_two<double>()));
        map[i] = static_cast<float>(std::pow(colour, 1.0 - featureError));
    }
    return map;
}

double flipMean(std::span<const float> map) {
    return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

}  // namespace lumulus::reference
