#include "light/photon/air_box.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lumulus::photon {

glm::dvec2 endsAlong(const Box& box, const glm::dvec3& direction) {
    glm::dvec2 ends(glm::dot(box.origin, direction));
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::dot(box.edges[axis], direction) * box.size[axis];
        ends += glm::dvec2(std::min(0.0, length), std::max(0.0, length));
    }
    return ends;
}

glm::dvec4 placeAlong(const Box& box, const glm::dvec3& direction, const glm::dvec2& ends) {
    const double length = std::max(ends.y - ends.x, 1e-6);
    return glm::dvec4(glm::transpose(box.edges) * direction / length,
                      (glm::dot(box.origin, direction) - ends.x) / length);
}

void makeAlias(const std::vector<double>& weights, std::vector<shared::SkyCell>& cells) {
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    std::vector<double> share;
    std::vector<std::size_t> small, large;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        share.push_back(weights[i] / sum * static_cast<double>(weights.size()));
        (share[i] < 1.0 ? small : large).push_back(i);
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
        cells[i].keep = 1.0F;
        cells[i].other = static_cast<std::uint32_t>(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::size_t less = small.back(), more = large.back();
        small.pop_back();
        cells[less].keep = static_cast<float>(share[less]);
        cells[less].other = static_cast<std::uint32_t>(more);
        share[more] -= 1.0 - share[less];
        if (share[more] >= 1.0) continue;
        large.pop_back();
        small.push_back(more);
    }
}

glm::dvec3 acrossOf(const glm::dvec3& toSun, const glm::dvec3& up) {
    const glm::dvec3 across = toSun - glm::dot(toSun, up) * up;
    if (glm::length(across) > 1e-6) return glm::normalize(across);
    const glm::dvec3 aside = std::abs(up.x) < 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
    return glm::normalize(aside - glm::dot(aside, up) * up);
}

}  // namespace lumulus::photon
