#pragma once

#include <glm/glm.hpp>

#include "lamp/beam.h"
#include "lamp/haze.h"

namespace lumulus::lamp {

/// Part of a ray, metres from its origin.
struct Part {
    double begin = 0.0, end = 0.0;
};

/// Light of a lamp that the haze scatters once along a part of a ray, as it arrives at the ray's origin [W/(m² sr)].
/// `miss`: distance at which the ray passes the lamp [m], where it stands for other rays than this one; at least the
/// lamp's radius is taken.
///
/// The places are those of Gauss's rule of three points in u, where the distance to the place nearest to the lamp is
/// miss · sinh u: then u is the logarithm of tan(γ/2), with the angle γ of scattering, and both the rise of 1/r²
/// and a forward peak are wide. docs/lamps.md has the error.
glm::dvec3 onceScattered(const Haze& haze, const Beam& beam, const Ray& ray, const Part& part, double miss);

/// Distance at which a ray passes a point [m].
double missOf(const Ray& ray, const glm::dvec3& point);

}  // namespace lumulus::lamp
