#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
#include "vdb/volume.h"

/// A procedural cloud that moves: the same at any time, and with known velocities.
namespace lumulus::vdb {

/// Velocities at voxels, as Volume has densities.
struct VelocityGrid {
    glm::ivec3 size{0};
    std::vector<glm::vec3> values;  ///< m/s, x fastest
    Affine toWorld;                 ///< voxel coordinates → metres
};

/// How a cloud moves: with the wind, and in itself by a flow without sources that the wind carries along (that of
/// Arnold, Beltrami and Childress, with waves of half the cloud's length).
struct Flow {
    glm::dvec3 wind{0.0};  ///< m/s
    double swirl = 0.0;    ///< m/s, root mean square
    double wave = 1.0;     ///< m

    /// For a cloud at rest.
    Flow(const Volume& cloud, const glm::dvec3& theWind, double theSwirl);
    /// [m/s]
    glm::dvec3 velocity(const glm::dvec3& place, double seconds) const;
    /// Where what is at a place now was at time 0 [m].
    glm::dvec3 origin(const glm::dvec3& place, double seconds) const;
};

/// Voxels that deformed() makes; more than there is memory for, perhaps.
double voxelsOfDeformed(const Volume& cloud, const Flow& flow, double seconds);
/// The cloud after so many seconds, in voxels as large as those that it had. Errors: what `check` throws.
Volume deformed(const Volume& cloud, const Flow& flow, double seconds, const Check& check = stopIfInterrupted);

/// Velocities where such a cloud is, in voxels twice as large.
VelocityGrid velocitiesOf(const Volume& cloud, const Flow& flow, double seconds);

}  // namespace lumulus::vdb
