#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "base/interrupt.h"
#include "query/clouds.h"

namespace lumulus::fog_change {

/// The part of a way that lies in a box: distances x to y; x ≥ y: none.
glm::dvec2 partInBox(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dvec3& origin,
                     const glm::dvec3& direction);

/// Mean extinction of all clouds in the cubes of a grid along the axes of the world.
class CloudGrid {
  public:
    /// Nothing lies below `lowest`. Errors: what `check` throws.
    CloudGrid(const query::Clouds& clouds, std::optional<double> lowest, const Check& check);
    /// One extinction [1/m] in a box.
    CloudGrid(const glm::dvec3& lower, const glm::dvec3& upper, double extinction);

    const glm::dvec3& lower() const { return lower_; }
    const glm::dvec3& upper() const { return upper_; }
    bool contains(const glm::dvec3& point) const;
    double extinctionAt(const glm::dvec3& point) const;
    std::size_t bytes() const { return extinction_.size() * sizeof(float); }

    /// Distance at which light that can meet an optical depth has met it; none within `length`.
    std::optional<double> collision(const glm::dvec3& origin, const glm::dvec3& direction, double length,
                                    double depth) const;

  private:
    std::size_t indexOf(const glm::ivec3& cell) const;

    glm::dvec3 lower_{0.0}, upper_{0.0}, edge_{1.0};
    glm::ivec3 cells_{1};
    std::vector<float> extinction_;
};

}  // namespace lumulus::fog_change
