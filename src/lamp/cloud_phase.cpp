#include "lamp/cloud_phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/phase_table.h"

namespace lumulus::lamp {

glm::dvec3 CloudPhase::between(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 difference = to - from, sum = to + from;
    const auto away = static_cast<float>(0.5 * glm::dot(difference, difference));
    const auto back = static_cast<float>(0.5 * glm::dot(sum, sum));
    const shared::ScatterAngle angle(away, back, std::sqrt(away * back));
    if (tables_.analyticHg) return glm::dvec3(static_cast<double>(shared::henyeyGreenstein(tables_.g, angle)));
    const shared::TableCell cell =
        shared::tableCell(shared::angleToAxis(angle, tables_.angleScale), shared::phaseTableSize);
    glm::dvec3 result(0.0);
    for (int channel = 0; channel < 3; ++channel) {
        const auto at = [&](int entry) {
            return tables_.phaseTable[static_cast<std::size_t>(tables_.coloured ? 3 * entry + channel : entry)];
        };
        result[channel] = static_cast<double>(std::exp(glm::mix(at(cell.base), at(cell.base + 1), cell.fraction)));
    }
    return result;
}

glm::dvec3 CloudPhase::sample(const glm::dvec3& from, const glm::dvec3& u) const {
    if (u.z < static_cast<double>(tables_.forwardFraction)) return from;
    shared::ScatterAngle angle(0.0F, 2.0F, 0.0F);
    if (tables_.analyticHg) {
        angle = shared::sampleHg(tables_.g, static_cast<float>(u.x), tables_.scatterFraction);
    } else {
        const shared::TableCell cell = shared::inverseCdfCell(static_cast<float>(u.x));
        const auto at = [&](int entry) { return tables_.inverseCdf[static_cast<std::size_t>(entry)]; };
        angle = shared::angleFromOneMinusCos(glm::mix(at(cell.base), at(cell.base + 1), cell.fraction));
    }
    const auto azimuth = static_cast<float>(2.0 * std::numbers::pi * u.y);
    return glm::normalize(glm::dvec3(shared::rotateDirection(glm::vec3(from), angle, azimuth)));
}

}  // namespace lumulus::lamp
