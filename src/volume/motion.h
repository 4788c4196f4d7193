#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "scene/scene.h"
#include "vdb/read_limits.h"
#include "vdb/velocity.h"

namespace lumulus {

/// Velocity of what is in the file of a cloud: its grid of velocities, else what the scene says, else none is known.
class CloudVelocity {
  public:
    /// `density`: of the file, where it has its own place. Errors: those of vdb::VelocityField::read().
    CloudVelocity(const scene::Cloud& cloud, const vdb::VoxelBox& density, const vdb::ReadLimits& limits);

    bool isKnown() const { return field_ || told_; }
    /// At a place in the file's own coordinates [m/s].
    glm::dvec3 at(const glm::dvec3& place) const;
    /// Where what is at a place was or will be after these seconds: half a step to its middle, then a whole one.
    glm::dvec3 carried(const glm::dvec3& place, double seconds) const;

  private:
    std::optional<vdb::VelocityField> field_;
    std::optional<scene::Wind> told_;  ///< by the scene
};

/// How what is in a cloud has moved from one frame to another.
struct CloudMotion {
    bool goesOn = true;  ///< false: another piece of a sequence begins
    bool known = true;   ///< false: densities change, and nothing is known of velocities
    /// Way that what is at a place has come, in the cloud's own coordinates, without `transform` [m].
    std::function<glm::dvec3(const glm::dvec3&)> way = [](const glm::dvec3&) { return glm::dvec3(0.0); };
};

/// Errors: as above.
CloudMotion motionBetween(const scene::Cloud& before, const scene::Cloud& now, const vdb::VoxelBox& density,
                          const vdb::ReadLimits& limits);

}  // namespace lumulus
