#pragma once

#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "base/image.h"

/// How far a picture is from one of the reference.
namespace lumulus::test {

struct Distance {
    double bias = 0.0;      ///< of the sum of all pixels
    double relative = 0.0;  ///< relMSE, without the reference's own noise
    double noise = 0.0;     ///< standard error of the reference's sum, over it
};

inline Distance distanceOf(const LayeredImage& image, const LayeredImage& reference) {
    double sum = 0.0, expected = 0.0, error = 0.0, variances = 0.0;
    const double epsilon = 1e-2;
    for (const char* name : {"R", "G", "B"}) {
        const std::vector<float>& found = image.layers.at(name);
        const std::vector<float>& right = reference.layers.at(name);
        const std::vector<float>& variance = reference.layers.at(std::string("variance.") + name);
        double mean = 0.0;
        for (const float value : right) mean += static_cast<double>(value);
        mean /= static_cast<double>(right.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            const auto f = static_cast<double>(found[i]), r = static_cast<double>(right[i]);
            sum += f;
            expected += r;
            variances += static_cast<double>(variance[i]);
            error += ((f - r) * (f - r) - static_cast<double>(variance[i])) / (r * r + epsilon * mean * mean);
        }
    }
    const Distance result{sum / expected - 1.0, error / (3.0 * static_cast<double>(image.pixels())),
                          std::sqrt(variances) / expected};
    std::cout << "bias " << result.bias << " ± " << result.noise << ", relMSE " << result.relative << "\n";
    return result;
}

}  // namespace lumulus::test
