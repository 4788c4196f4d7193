#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace lumulus::scene {

/// Velocity of the air by height. A constant wind has one level.
struct Wind {
    struct Level {
        double height = 0.0;       ///< metres
        glm::dvec3 velocity{0.0};  ///< m/s

        bool operator==(const Level&) const = default;
    };
    /// Levels at most.
    static constexpr std::size_t mostLevels = 1000;

    Wind() = default;
    Wind(const glm::dvec3& velocity) : levels{Level{0.0, velocity}} {}

    std::vector<Level> levels{Level{}};  ///< one or more, their heights rising

    /// Velocity at a height: linear between levels, that of the nearest one beyond them [m/s].
    glm::dvec3 at(double height) const;

    bool operator==(const Wind&) const = default;
};

}  // namespace lumulus::scene
