#pragma once

#include <cstddef>
#include <glm/glm.hpp>

namespace lumulus {

/// Where a cloud of an edited scene comes from: it has the density of a cloud that was there.
struct CloudOrigin {
    std::size_t from = 0;    ///< number of that cloud before
    bool added = false;      ///< beside it: no photon has seen this one yet
    bool substance = false;  ///< whether albedo or phase function are others
    // of one that was added, in which it differs from that cloud as the scene has it:
    double yaw = 0.0;      ///< about the vertical through its middle, anticlockwise as seen from above [radians]
    double scale = 1.0;    ///< about its middle
    glm::dvec3 move{0.0};  ///< after that [m]
};

}  // namespace lumulus
