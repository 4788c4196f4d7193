#include "service/render/noise.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace lumulus::service {

double nestedNoise(const LayeredImage& earlier, int earlierCount, const LayeredImage& later, int laterCount) {
    assert(0 < earlierCount && earlierCount < laterCount);
    constexpr float leastAlpha = 1e-3F;  // as in the definition of relMSE: transmittance below .999
    const std::vector<float>& alpha = later.layers.at("cloud.A");
    double sum = 0.0, counted = 0.0;
    for (const char* name : {"R", "G", "B"}) {
        const std::vector<float>& a = earlier.layers.at(name);
        const std::vector<float>& b = later.layers.at(name);
        double mean = 0.0, pixels = 0.0;
        for (std::size_t i = 0; i < b.size(); ++i)
            if (alpha[i] > leastAlpha) {
                mean += static_cast<double>(b[i]);
                pixels += 1.0;
            }
        if (pixels == 0.0) return 0.0;
        const double floor = 0.01 * std::pow(mean / pixels, 2);
        for (std::size_t i = 0; i < b.size(); ++i)
            if (alpha[i] > leastAlpha) {
                const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
                const double norm = std::pow(static_cast<double>(b[i]), 2) + floor;
                sum += norm > 0.0 ? difference * difference / norm : 0.0;
            }
        counted += pixels;
    }
    const double n1 = earlierCount, n2 = laterCount;
    return sum / counted / (n2 / n1 - 1.0);
}

bool NoiseEstimate::wants(int generations) const {
    if (!last_) return true;
    return relMseTimesPhotons_ ? generations >= 2 * last_->generations : generations > last_->generations;
}

void NoiseEstimate::add(LayeredImage picture, int generations, std::uint64_t photons) {
    if (last_ && last_->generations > 0 && generations > last_->generations)
        relMseTimesPhotons_ =
            nestedNoise(last_->image, last_->generations, picture, generations) * static_cast<double>(photons);
    last_ = Picture{std::move(picture), generations};
}

std::optional<double> NoiseEstimate::relMse(std::uint64_t photons) const {
    if (!relMseTimesPhotons_ || photons == 0) return std::nullopt;
    return *relMseTimesPhotons_ / static_cast<double>(photons);
}

NoiseEstimate NoiseEstimate::withoutPicture() const {
    NoiseEstimate result;
    result.relMseTimesPhotons_ = relMseTimesPhotons_;
    return result;
}

}  // namespace lumulus::service
