#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "reference/air_medium.h"
#include "reference/random.h"

/// What free paths of several channels share: one channel draws the path, and its density is the mean over the choice.
namespace lumulus::reference {

inline double sumOf(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

inline double sumOf(const Four& v) {
    return (v.x + v.y) + (v.z + v.w);
}

/// A channel with the probability of its share in the throughput.
inline int channelOf(const glm::dvec3& throughput, Random& random) {
    const double at = random.uniform() * sumOf(throughput);
    if (at < throughput.x) return 0;
    return at < throughput.x + throughput.y || throughput.z == 0.0 ? 1 : 2;
}

inline int channelOf(const Four& throughput, Random& random) {
    double left = random.uniform() * sumOf(throughput);
    int last = 0;
    for (int i = 0; i < 4; ++i) {
        if (!(throughput[i] > 0.0)) continue;
        last = i;
        left -= throughput[i];
        if (left < 0.0) break;
    }
    return last;
}

/// e^−depth over that of the clearest channel that has light, so that it does not underflow; 0 where there is no light.
template <typename Light>
Light relativeTransmittance(const Light& depth, const Light& throughput) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < Light::length(); ++i) {
        if (throughput[i] > 0.0) least = std::min(least, depth[i]);
    }
    Light result(0.0);
    for (int i = 0; i < Light::length(); ++i) {
        if (throughput[i] > 0.0) result[i] = std::exp(least - depth[i]);
    }
    return result;
}

}  // namespace lumulus::reference
