#include "prefilter/prefilter.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface/material/microfacet.h"

namespace lumulus::prefilter {

namespace {

/// Solid angle of a texel by that of their mean, for a direction whose largest part is `largest`: its cube, and a
/// factor. As a level of detail.
float levelOfPlace(const glm::vec3& direction) {
    const float largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    constexpr float middle = 0.4667F;  // ½ log₂ of (4 / size²) / (4π / 6 size²)
    return 1.5F * std::log2(largest) + middle;
}

}  // namespace

std::uint32_t usualSamples(double alpha) {
    return alpha < 0.1 ? 256 : 1024;
}

Lobe ggxLobe(double alpha, int size, double texel, const LobeOptions& options) {
    using std::numbers::pi;
    const double mean = 4.0 * pi / (6.0 * size * size);
    if (alpha < material::smoothest)
        return {{glm::vec3(0.0F, 0.0F, 1.0F), 1.0F, static_cast<float>(0.5 * std::log2(std::max(1.0, texel / mean)))}};
    const std::uint32_t samples = options.samples > 0 ? options.samples : usualSamples(alpha);
    Lobe lobe;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const glm::dvec3 half =
            material::sampleNormal(material::Microfacets::ggx, alpha, material::spreadPoint(i, samples));
        const glm::dvec3 light(2.0 * half.z * half.x, 2.0 * half.z * half.y, 2.0 * half.z * half.z - 1.0);
        if (!(light.z > 0.0)) continue;
        const double density = material::normals(material::Microfacets::ggx, half, alpha) / 4.0;
        const double level = 0.5 * std::log2(options.blur / (samples * density * mean));
        lobe.push_back({glm::vec3(light), static_cast<float>(light.z), static_cast<float>(level)});
        sum += light.z;
    }
    for (Reading& reading : lobe) reading.share = static_cast<float>(reading.share / sum);
    return lobe;
}

glm::mat3 frameOf(const glm::vec3& n) {
    const glm::vec3 beside = std::abs(n.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
    const glm::vec3 right = glm::normalize(glm::cross(beside, n));
    return {right, glm::cross(n, right), n};
}

std::vector<glm::vec3> filtered(const CubeMap& map, const Lobe& lobe, std::span<const glm::vec3> directions,
                                const Check& check) {
    std::vector<glm::vec3> values(directions.size());
    constexpr std::size_t grain = 64;
    const bool mirror = lobe.size() == 1;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, directions.size(), grain), [&](const auto& range) {
        check();
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const glm::mat3 frame = frameOf(directions[i]);
            glm::vec3 sum(0.0F);
            for (const Reading& reading : lobe) {
                const glm::vec3 towards = frame * reading.towards;
                const float level = mirror ? reading.level : reading.level - levelOfPlace(towards);
                sum += reading.share * map.at(towards, level);
            }
            values[i] = sum;
        }
    });
    return values;
}

}  // namespace lumulus::prefilter
