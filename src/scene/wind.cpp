#include "scene/wind.h"

#include <algorithm>

namespace lumulus::scene {

glm::dvec3 Wind::at(double height) const {
    const auto above = std::ranges::upper_bound(levels, height, {}, &Level::height);
    if (above == levels.begin()) return levels.front().velocity;
    if (above == levels.end()) return levels.back().velocity;
    const Level& below = *(above - 1);
    const double share = (height - below.height) / (above->height - below.height);
    return glm::mix(below.velocity, above->velocity, share);
}

}  // namespace lumulus::scene
