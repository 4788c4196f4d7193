#include "base/exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace lumulus {
namespace {

constexpr double efficacy = 683.0;  // lm/W
constexpr double cloudPercentile = 0.98, cloudValue = 0.8;
constexpr double skyPercentile = 0.5, skyValue = 0.18;
/// A fifth of a picture is not to be brighter than that, however dark the rest is.
constexpr double brightPercentile = 0.8, brightValue = 0.6;
constexpr double leastCover = 0.02;
constexpr std::size_t mostSamples = std::size_t{1} << 18;

/// A luminance with its weight.
struct Sample {
    double luminance;
    double weight;
};

/// Luminances above 0 of some pixels with their histogram over the binary logarithm in eighths.
class Meter {
  public:
    void add(const Sample& sample) {
        if (!std::isfinite(sample.luminance) || !(sample.weight > 0.0)) return;
        if (!(sample.luminance > 0.0)) {
            dark_ += sample.weight;
            return;
        }
        samples_.push_back(sample);
        weights_[binOf(sample.luminance)] += sample.weight;
        total_ += sample.weight;
    }

    double total() const { return total_; }

    /// As percentile(), of the dark pixels too: 0 where they are the share.
    double percentileOfAll(double share) const {
        const double left = share * (total_ + dark_) - dark_;
        return left > 0.0 && total_ > 0.0 ? percentile(left / total_) : 0.0;
    }

    /// The luminance below which a share of the weight lies; exact within the bin, so that it scales as the radiance.
    double percentile(double share) const {
        double left = share * total_;
        std::size_t bin = 0;
        while (bin + 1 < bins && left > weights_[bin]) left -= weights_[bin++];
        std::vector<Sample> within;
        std::ranges::copy_if(samples_, std::back_inserter(within),
                             [&](const Sample& s) { return binOf(s.luminance) == bin; });
        std::ranges::stable_sort(within, {}, &Sample::luminance);
        for (const Sample& s : within) {
            left -= s.weight;
            if (left <= 0.0) return s.luminance;
        }
        return within.empty() ? 0.0 : within.back().luminance;
    }

  private:
    static constexpr int perStop = 8, stops = 64;  // from 2^−32 to 2^32
    static constexpr std::size_t bins = std::size_t{perStop} * stops;

    static std::size_t binOf(double luminance) {
        const double place = perStop * (std::log2(luminance) + stops / 2);
        return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)));
    }

    std::vector<Sample> samples_;
    std::array<double, bins> weights_{};
    double total_ = 0.0, dark_ = 0.0;
};

/// Red, green, blue and alpha of a picture; null where it has no such layer.
struct Layers {
    std::array<const float*, 3> colour{};
    const float* alpha = nullptr;

    Layers(const LayeredImage& image, const char* r, const char* g, const char* b, const char* a) {
        const auto find = [&](const char* name) {
            const auto it = image.layers.find(name);
            return it == image.layers.end() ? nullptr : it->second.data();
        };
        colour = {find(r), find(g), find(b)};
        alpha = find(a);
    }

    bool complete() const { return colour[0] != nullptr && colour[1] != nullptr && colour[2] != nullptr; }

    double luminance(std::size_t i) const {
        return 0.2126 * static_cast<double>(colour[0][i]) + 0.7152 * static_cast<double>(colour[1][i]) +
               0.0722 * static_cast<double>(colour[2][i]);
    }
};

/// Adds every `step`th pixel: the clouds by themselves, and the whole picture.
void addPicture(const LayeredImage& image, std::size_t step, Meter& clouds, Meter& all) {
    const Layers cloud(image, "cloud.R", "cloud.G", "cloud.B", "cloud.A");
    const Layers whole(image, "R", "G", "B", "A");
    for (std::size_t i = step / 2; i < image.pixels(); i += step) {
        if (cloud.complete() && cloud.alpha != nullptr) {
            const double alpha = static_cast<double>(cloud.alpha[i]);
            if (alpha > 0.0) clouds.add({cloud.luminance(i) / alpha, alpha});
        }
        if (!whole.complete()) continue;
        const double alpha = whole.alpha != nullptr ? static_cast<double>(whole.alpha[i]) : 1.0;
        if (alpha > 0.0) all.add({whole.luminance(i) / alpha, alpha});
    }
}

/// Adds every `step`th pixel of what is behind the clouds.
void addBackground(const LayeredImage& image, std::size_t step, Meter& free) {
    const Layers cloud(image, "cloud.R", "cloud.G", "cloud.B", "cloud.A");
    const Layers whole(image, "R", "G", "B", "A");
    const bool clouds = cloud.complete() && cloud.alpha != nullptr;
    for (std::size_t i = step / 2; whole.complete() && i < image.pixels(); i += step) {
        const double left = clouds ? 1.0 - static_cast<double>(cloud.alpha[i]) : 1.0;
        const double behind = whole.luminance(i) - (clouds ? cloud.luminance(i) : 0.0);
        if (left > 0.01) free.add({behind / left, left});
    }
}

/// How many pixels are looked at, and which: every so many-th.
std::pair<double, std::size_t> samplesOf(std::span<const LayeredImage* const> pictures) {
    std::size_t pixels = 0;
    for (const LayeredImage* picture : pictures) pixels += picture->pixels();
    const std::size_t step = (pixels + mostSamples - 1) / mostSamples | 1;  // odd: not the same columns in every row
    return {static_cast<double>(pixels) / static_cast<double>(step), step};
}

/// Factor that shows a picture without clouds. From high above half of it may be next to black.
double wholeGain(const Meter& all) {
    const double middle = all.percentileOfAll(skyPercentile), bright = all.percentileOfAll(brightPercentile);
    if (bright > 0.0) return middle > 0.0 ? std::min(skyValue / middle, brightValue / bright) : brightValue / bright;
    const double lit = all.percentile(skyPercentile);
    return lit > 0.0 ? skyValue / lit : 1.0;
}

}  // namespace

double gainOfEv100(double ev100) {
    return efficacy / (1.2 * std::exp2(ev100));
}

double ev100OfGain(double gain) {
    return std::log2(efficacy / (1.2 * gain));
}

std::optional<double> backgroundGain(std::span<const LayeredImage* const> pictures) {
    const auto [pixels, step] = samplesOf(pictures);
    Meter free;
    for (const LayeredImage* picture : pictures) addBackground(*picture, step, free);
    const double luminance = free.percentile(skyPercentile);
    if (free.total() < leastCover * pixels || !(luminance > 0.0)) return std::nullopt;
    return skyValue / luminance;
}

double meteredGain(std::span<const LayeredImage* const> pictures) {
    const auto [seen, step] = samplesOf(pictures);
    Meter clouds, all;
    for (const LayeredImage* picture : pictures) addPicture(*picture, step, clouds, all);
    const bool cloudy = clouds.total() >= leastCover * seen;
    if (!cloudy) return wholeGain(all);
    const double luminance = clouds.percentile(cloudPercentile);
    return luminance > 0.0 ? cloudValue / luminance : 1.0;
}

}  // namespace lumulus
