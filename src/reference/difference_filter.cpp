#include "reference/difference_filter.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace lumulus::reference {
namespace {

/// Values over the pixels of a picture.
template <typename T>
using Map = std::vector<T>;

struct Size {
    int width, height;

    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// In which sums are added up.
template <typename T>
using SumOf = std::conditional_t<std::is_same_v<T, float>, double, glm::dvec3>;

/// Means over 2·radius + 1 pixels along a line of `count` values that are `stride` apart; 0 lies beyond its ends.
template <typename T>
void meansOfLine(const T* from, T* to, int count, std::size_t stride, int radius) {
    const auto value = [&](int i) { return SumOf<T>(from[static_cast<std::size_t>(i) * stride]); };
    const double share = 1.0 / (2.0 * radius + 1.0);
    SumOf<T> sum(0.0);
    for (int i = 0; i < std::min(radius, count); ++i) sum += value(i);
    for (int i = 0; i < count; ++i) {
        if (i + radius < count) sum += value(i + radius);
        to[static_cast<std::size_t>(i) * stride] = T(sum * share);
        if (i >= radius) sum -= value(i - radius);
    }
}

/// Three times the mean over a square, which is near to a Gaussian of variance radius·(radius + 1) along each axis.
template <typename T>
Map<T> smoothed(Map<T> map, const Size& size, int radius) {
    if (radius == 0) return map;
    Map<T> other(map.size());
    const auto stride = static_cast<std::size_t>(size.width);
    for (int pass = 0; pass < 3; ++pass) {
        tbb::parallel_for(0, size.height, [&](int y) {
            meansOfLine(&map[size.at(0, y)], &other[size.at(0, y)], size.width, 1, radius);
        });
        tbb::parallel_for(0, size.width, [&](int x) {
            meansOfLine(&other[size.at(x, 0)], &map[size.at(x, 0)], size.height, stride, radius);
        });
    }
    return map;
}

/// Sum of the squared weights of that.
double squaresOf(int radius) {
    const int edge = 2 * radius + 1;
    std::vector<double> line(static_cast<std::size_t>(edge), 1.0 / edge), wider;
    for (int pass = 0; pass < 2; ++pass) {
        wider.assign(line.size() + static_cast<std::size_t>(edge) - 1, 0.0);
        for (std::size_t i = 0; i < line.size(); ++i)
            for (std::size_t k = 0; k < static_cast<std::size_t>(edge); ++k) wider[i + k] += line[i] / edge;
        line = wider;
    }
    double sum = 0.0;
    for (const double weight : line) sum += weight * weight;
    return sum * sum;
}

float meanOf(const glm::vec3& rgb) {
    return (rgb.x + rgb.y + rgb.z) / 3.0F;
}

glm::vec3 over(const glm::vec3& a, const glm::vec3& b) {
    return glm::mix(glm::vec3(0.0F), a / b, glm::greaterThan(b, glm::vec3(0.0F)));
}

glm::dvec3 sumOf(const Map<glm::vec3>& map) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& value : map) sum += glm::dvec3(value);
    return sum;
}

class Filter {
  public:
    explicit Filter(const DifferenceMap& map)
        : map_(map),
          size_{map.width, map.height},
          whole_(over(sumOf(map.difference), glm::dvec3(sumOf(map.light)))),
          variance_(smoothed(map.variance, size_, 2)),
          coarse_(map.counted.size(), whole_),
          kept_(map.counted.size(), whole_) {
        // the variance of a pixel is known from few paths: it has the mean of those around it
        const Map<float> counted = smoothed(map.counted, size_, 2);
        overPixels([&](std::size_t i) { variance_[i] = map.counted[i] > 0.0F ? variance_[i] / counted[i] : 0.0F; });
    }

    Map<glm::vec3> run() {
        int radius = 1;
        while (2 * radius <= std::min(map_.width, map_.height) / 3) radius *= 2;
        for (; radius > 0; radius /= 2) addBand(radius);
        addBand(0);
        return inTheWhole();
    }

  private:
    /// Adds the detail between the means over this radius and those over the radius before.
    void addBand(int radius) {
        const Map<glm::vec3> light = smoothed(map_.light, size_, radius);
        Map<glm::vec3> fine = smoothed(map_.difference, size_, radius);
        // weights are narrower when squared
        Map<float> noise = smoothed(variance_, size_, static_cast<int>(std::lround(0.7 * radius)));
        Map<float> energy(noise.size());
        const auto squares = static_cast<float>(squaresOf(radius));
        overPixels([&](std::size_t i) {
            fine[i] = map_.counted[i] * over(fine[i], light[i]);
            const float scale = meanOf(light[i]);
            noise[i] = scale > 0.0F ? map_.counted[i] * noise[i] * squares / (scale * scale) : 0.0F;
            const float detail = map_.counted[i] * meanOf(fine[i] - coarse_[i]);
            energy[i] = detail * detail;
        });
        const int around = std::max(2, radius);
        noise = smoothed(std::move(noise), size_, around);
        // as blurred as the variances are, lest a single bright path stand above the noise that it makes
        energy = smoothed(smoothed(std::move(energy), size_, 2), size_, around);
        overPixels([&](std::size_t i) { kept_[i] += trust(noise[i], energy[i]) * (fine[i] - coarse_[i]); });
        coarse_ = std::move(fine);
    }

    /// None up to twice the noise in energy, nearly all from four times on.
    static float trust(float noise, float energy) {
        if (!(energy > 2.0F * noise)) return 0.0F;
        const float share = noise / energy;
        return 1.0F - 4.0F * share * share;
    }

    /// What was kept, in light, with the sum of the difference.
    Map<glm::vec3> inTheWhole() {
        overPixels([&](std::size_t i) { kept_[i] *= map_.light[i]; });
        const glm::vec3 more = over(sumOf(map_.difference) - sumOf(kept_), glm::dvec3(sumOf(map_.light)));
        overPixels([&](std::size_t i) { kept_[i] += more * map_.light[i]; });
        return std::move(kept_);
    }

    template <typename Do>
    void overPixels(const Do& of) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, map_.counted.size()), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) of(i);
        });
    }

    const DifferenceMap& map_;
    Size size_;
    glm::vec3 whole_;  ///< ratio over the whole picture
    Map<float> variance_;
    Map<glm::vec3> coarse_;  ///< ratios over the radius before
    Map<glm::vec3> kept_;
};

}  // namespace

std::vector<glm::vec3> filterDifference(const DifferenceMap& map) {
    return Filter(map).run();
}

}  // namespace lumulus::reference
