#include "reference/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace lumulus::reference {
namespace {

constexpr std::array<const char*, 3> channels{"R", "G", "B"};
constexpr double relativeFloor = 0.01;  ///< of mean(D)², and of mean(D) for MAPE

/// A layer's values as double, or a constant if there is no such layer.
class Layer {
  public:
    Layer(const LayeredImage& image, const std::string& name) {
        const auto found = image.layers.find(name);
        if (found != image.layers.end()) values_ = found->second.data();
    }

    bool present() const { return values_ != nullptr; }
    double at(std::size_t pixel, double absent = 0.0) const {
        return values_ != nullptr ? static_cast<double>(values_[pixel]) : absent;
    }

  private:
    const float* values_ = nullptr;
};

/// One picture's radiance and variance in one channel.
struct Channel {
    Layer radiance;
    Layer variance;

    Channel(const LayeredImage& image, const std::string& name)
        : radiance(image, name), variance(image, "variance." + name) {}
};

/// The pixels to compare. Errors: InputError if there are none.
std::vector<std::size_t> comparedPixels(const LayeredImage& shown, const LayeredImage& reference) {
    std::vector<std::size_t> pixels = cloudPixels(shown, reference);
    if (pixels.empty()) {
        throw InputError("no pixel of the reference shows the cloud", "transmittance", "compare pictures of a cloud");
    }
    return pixels;
}

/// A weighted mean over pixels and channels with the variance of its noise.
struct Mean {
    double sum = 0.0;
    double variance = 0.0;
    double pixelDeviation = 0.0;  ///< of the pixel under way: standard deviations of its channels, added

    void add(double value, double deviation) {
        sum += value;
        pixelDeviation += deviation;
    }
    void endPixel() {
        variance += pixelDeviation * pixelDeviation;
        pixelDeviation = 0.0;
    }
    Measure over(double count, bool noiseKnown) const {
        Measure measure{sum / count, {}};
        if (noiseKnown) measure.standardError = std::sqrt(variance) / count;
        return measure;
    }
};

struct Sums {
    Mean square, relative, signedDifference, percentage;
    double imageNoise = 0.0, referenceNoise = 0.0;

    void endPixel() {
        square.endPixel();
        relative.endPixel();
        signedDifference.endPixel();
        percentage.endPixel();
    }
};

/// Values and variances of one pixel and channel: the picture, one or two references, the denominator.
struct Point {
    double image, imageVariance;
    double a, aVariance;
    double b, bVariance;
    double denominator;
    bool twoReferences;

    double reference() const { return twoReferences ? 0.5 * (a + b) : a; }
    double referenceVariance() const { return twoReferences ? 0.25 * (aVariance + bVariance) : aVariance; }
    double square() const { return (image - a) * (image - b); }

    /// Variance of `square` for normal noise around a true difference δ.
    double squareVariance() const {
        const double vi = imageVariance, va = aVariance, vb = bVariance;
        if (twoReferences) {
            const double trueSquare = std::max(0.0, square() - vi);
            return trueSquare * (4.0 * vi + va + vb) + 2.0 * vi * vi + vi * (va + vb) + va * vb;
        }
        const double v = vi + va;
        return 4.0 * std::max(0.0, square() - v) * v + 2.0 * v * v;
    }
};

/// A relative value. With a black reference it is 0 for no difference and infinite for any other.
double ratio(double value, double scale) {
    return value == 0.0 ? 0.0 : value / scale;
}

void addPoint(Sums& sums, const Point& p, double meanDenominator) {
    const double difference = p.image - p.reference();
    const double deviation = std::sqrt(p.imageVariance + p.referenceVariance());
    const double squareDeviation = std::sqrt(p.squareVariance());
    const double square = p.denominator * p.denominator + relativeFloor * meanDenominator * meanDenominator;
    const double level = std::abs(p.denominator) + relativeFloor * std::abs(meanDenominator);
    sums.square.add(p.square(), squareDeviation);
    sums.relative.add(ratio(p.square(), square), ratio(squareDeviation, square));
    sums.signedDifference.add(difference, deviation);
    sums.percentage.add(ratio(std::abs(difference), level), ratio(deviation, level));
    sums.imageNoise += ratio(p.imageVariance, square);
    sums.referenceNoise += ratio(p.referenceVariance(), square);
}

Measure rootOf(const Measure& square) {
    Measure root{std::sqrt(std::max(0.0, square.value)), {}};
    // the error of a root at 0 is not linear: its square's error bounds it
    if (square.standardError) {
        root.standardError = root.value * root.value > *square.standardError
                                 ? *square.standardError / (2.0 * root.value)
                                 : std::sqrt(*square.standardError);
    }
    return root;
}

/// Radiance and variance in R, G and B.
std::vector<Channel> channelsOf(const LayeredImage& image) {
    std::vector<Channel> result;
    for (const char* name : channels) result.emplace_back(image, name);
    return result;
}

/// The mean over pixels and channels of two pictures' mean.
double meanRadiance(const std::vector<Channel>& as, const std::vector<Channel>& bs,
                    const std::vector<std::size_t>& pixels) {
    const double count = 3.0 * static_cast<double>(pixels.size());
    double mean = 0.0;
    for (const std::size_t i : pixels) {
        for (std::size_t c = 0; c < 3; ++c) mean += 0.5 * (as[c].radiance.at(i) + bs[c].radiance.at(i)) / count;
    }
    return mean;
}

Comparison compareAll(const LayeredImage& image, const LayeredImage& a, const LayeredImage& b,
                      const LayeredImage* denominator, bool two) {
    const std::vector<std::size_t> pixels = comparedPixels(denominator != nullptr ? *denominator : a, a);
    const std::vector<Channel> images = channelsOf(image), as = channelsOf(a), bs = channelsOf(b);
    const std::vector<Channel> scales = denominator != nullptr ? channelsOf(*denominator) : std::vector<Channel>{};
    const double count = 3.0 * static_cast<double>(pixels.size());
    const double mean = meanRadiance(as, bs, pixels);
    const double meanDenominator = scales.empty() ? mean : meanRadiance(scales, scales, pixels);
    Sums sums;
    for (const std::size_t i : pixels) {
        for (std::size_t c = 0; c < 3; ++c) {
            Point point{images[c].radiance.at(i),
                        images[c].variance.at(i),
                        as[c].radiance.at(i),
                        as[c].variance.at(i),
                        bs[c].radiance.at(i),
                        bs[c].variance.at(i),
                        0.0,
                        two};
            point.denominator = scales.empty() ? point.reference() : scales[c].radiance.at(i);
            addPoint(sums, point, meanDenominator);
        }
        sums.endPixel();
    }
    const bool imageKnown = images[0].variance.present();
    const bool referenceKnown = as[0].variance.present() && bs[0].variance.present();
    const bool known = imageKnown || referenceKnown;
    Comparison result;
    result.pixels = pixels.size();
    result.meanReference = mean;
    result.rmse = rootOf(sums.square.over(count, known));
    result.relMse = sums.relative.over(count, known);
    result.bias = sums.signedDifference.over(count, known);
    result.relativeBias = sums.signedDifference.over(count, known);
    result.relativeBias.value = ratio(result.relativeBias.value, mean);
    if (known) result.relativeBias.standardError = ratio(*result.relativeBias.standardError, std::abs(mean));
    result.mape = sums.percentage.over(count, known);
    if (imageKnown) result.imageNoise = sums.imageNoise / count;
    if (referenceKnown) result.referenceNoise = sums.referenceNoise / count;
    return result;
}

/// Refuses NaN and infinity, which would spread over the whole result.
void requireNumbers(const NamedImage& named) {
    std::vector<std::string> used{"sun.disc"};
    for (const char* channel : channels) {
        used.emplace_back(channel);
        used.push_back(std::string("variance.") + channel);
        used.push_back(std::string("transmittance.") + channel);
    }
    for (const std::string& name : used) {
        const auto found = named.image.layers.find(name);
        if (found == named.image.layers.end()) {
            if (name.size() > 1) continue;
            throw InputError("the picture has no layer " + name, named.name, "give one with R, G and B");
        }
        const bool mayBeNegative = !name.starts_with("variance.");
        for (std::size_t i = 0; i < found->second.size(); ++i) {
            const float value = found->second[i];
            if (std::isfinite(value) && (mayBeNegative || value >= 0.0F)) continue;
            const auto width = static_cast<std::size_t>(named.image.width);
            throw InputError(
                fmt::format("layer {} is {} at x {}, y {}", name,
                            std::isfinite(value) ? "below 0" : "not a finite number", i % width, i / width),
                named.name, "render the picture again");
        }
    }
}

std::string sizeText(const LayeredImage& image) {
    return std::to_string(image.width) + "×" + std::to_string(image.height);
}

}  // namespace

std::vector<std::size_t> cloudPixels(const LayeredImage& shown, const LayeredImage& reference) {
    const Layer red(shown, "transmittance.R"), green(shown, "transmittance.G"), blue(shown, "transmittance.B");
    const Layer disc(reference, "sun.disc");
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < shown.pixels(); ++i) {
        const bool cloud = std::min({red.at(i), green.at(i), blue.at(i)}) < 0.999;
        if (cloud && disc.at(i) <= 0.0) pixels.push_back(i);
    }
    return pixels;
}

void requireComparable(const NamedImage& image, const NamedImage& reference) {
    if (image.image.width != reference.image.width || image.image.height != reference.image.height) {
        throw InputError(
            "the pictures differ in size, " + sizeText(image.image) + " against " + sizeText(reference.image),
            image.name + ", " + reference.name, "render both at the same size");
    }
    requireNumbers(image);
    requireNumbers(reference);
}

Comparison compare(const LayeredImage& image, const LayeredImage& reference, const LayeredImage* denominator) {
    return compareAll(image, reference, reference, denominator, false);
}

Comparison compare(const LayeredImage& image, const LayeredImage& referenceA, const LayeredImage& referenceB,
                   const LayeredImage* denominator) {
    return compareAll(image, referenceA, referenceB, denominator, true);
}

}  // namespace lumulus::reference
