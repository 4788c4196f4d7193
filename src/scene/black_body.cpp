#include "scene/black_body.h"

#include <cmath>

namespace lumulus::scene {
namespace {

/// A Gaussian lobe with another width on each side of its middle; nm and 1/nm.
double lobe(double nanometres, double middle, double below, double above) {
    const double t = (nanometres - middle) * (nanometres < middle ? below : above);
    return std::exp(-0.5 * t * t);
}

/// x̄, ȳ, z̄ (Wyman, Sloan and Shirley 2013, JCGT 2(2), eq. 4).
glm::dvec3 matching(double nm) {
    return {1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) -
                0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
            0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
            1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 blackBodyXyz(double temperature) {
    constexpr double secondRadiation = 1.438776877e7;  // h c / k, nm K
    glm::dvec3 sum(0.0);
    for (double nm = 360.0; nm <= 830.0; nm += 1.0) {
        const double relative = nm / 560.0;  // Planck's law up to a factor
        sum += matching(nm) / (std::pow(relative, 5.0) * std::expm1(secondRadiation / (nm * temperature)));
    }
    return sum;
}

}  // namespace

glm::dvec2 blackBodyChromaticity(double temperature) {
    const glm::dvec3 xyz = blackBodyXyz(temperature);
    return glm::dvec2(xyz) / (xyz.x + xyz.y + xyz.z);
}

glm::dvec3 blackBodyColour(double temperature) {
    // columns are the primaries of Rec. 709
    const glm::dmat3 toXyz(0.4123908, 0.2126390, 0.0193308, 0.3575843, 0.7151687, 0.1191948, 0.1804808, 0.0721923,
                           0.9505322);
    const glm::dvec3 rgb = glm::max(glm::inverse(toXyz) * blackBodyXyz(temperature), glm::dvec3(0.0));
    return rgb / glm::dot(rgb, glm::dvec3(0.2126390, 0.7151687, 0.0721923));
}

}  // namespace lumulus::scene
