#pragma once

#include <glm/glm.hpp>

#include "medium/scattering_tables.h"

namespace lumulus::lamp {

/// Phase function of a cloud, as its tables have it. What they cut off its forward peak goes straight on.
class CloudPhase {
  public:
    explicit CloudPhase(phase::ScatteringTables tables) : tables_(std::move(tables)) {}

    /// Per channel, for light scattered from one unit vector to another [1/sr].
    glm::dvec3 between(const glm::dvec3& from, const glm::dvec3& to) const;

    /// A direction after scattering, drawn by numbers in [0, 1).
    glm::dvec3 sample(const glm::dvec3& from, const glm::dvec3& u) const;

  private:
    phase::ScatteringTables tables_;
};

}  // namespace lumulus::lamp
