#include "sky/scattering_table.h"

#include <algorithm>
#include <cmath>

#include "sky/shell.h"

namespace lumulus::sky {

namespace {

constexpr int sunTexels = MultipleScattering::sunTexels, heightTexels = MultipleScattering::heightTexels;
constexpr double lowestSun = -0.5;  // of the root of the cosine: 14.5° below the horizon

}  // namespace

double sunOfTexel(int i) {
    const double root = lowestSun + (1.0 - lowestSun) * i / (sunTexels - 1.0);
    return root * std::abs(root);
}

double heightOfTexel(int j) {
    return airTop * std::pow(j / (heightTexels - 1.0), 2);
}

TableCell tableCell(double height, double sun) {
    const double root = std::copysign(std::sqrt(std::abs(sun)), sun);
    const double x = std::clamp((root - lowestSun) / (1.0 - lowestSun), 0.0, 1.0) * (sunTexels - 1.0);
    const double y = std::sqrt(std::clamp(height / airTop, 0.0, 1.0)) * (heightTexels - 1.0);
    const int i = std::min(static_cast<int>(x), sunTexels - 2), j = std::min(static_cast<int>(y), heightTexels - 2);
    return {static_cast<std::uint32_t>(j * sunTexels + i), static_cast<float>(x - i), static_cast<float>(y - j)};
}

double sunFade(double sun) {
    return std::clamp((sun + 0.3) / 0.05, 0.0, 1.0);
}

double acrossTowardsSun(const AirPoint& p) {
    const double sine2 = 1.0 - p.sun * p.sun, most = std::sqrt(std::max(0.0, 1.0 - p.up * p.up));
    return sine2 > 1e-9 ? std::clamp((p.toSun - p.sun * p.up) / std::sqrt(sine2), -most, most) : 0.0;
}

MultipleScattering::Incident incidentOf(const std::array<Spectrum, harmonicCount>& coefficients) {
    MultipleScattering::Incident incident;
    const Spectrum first = glm::max(coefficients[0], Spectrum(1e-30));
    incident.logMean = glm::vec4(glm::log(first));
    incident.shape[0] = glm::vec4(1.0F);
    for (std::size_t i = 1; i < harmonicCount; ++i) incident.shape[i] = glm::vec4(coefficients[i] / first);
    return incident;
}

std::array<float, highestDegree + 1> momentsOf(const Air& air) {
    const auto moments = air.aerosolMoments();
    std::array<float, highestDegree + 1> result{};
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = static_cast<float>(moments[i]);
    return result;
}

}  // namespace lumulus::sky
