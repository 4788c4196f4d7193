#pragma once

#include "view/camera.h"

namespace lumulus::lamp {

/// The distance at which rays of a square of the picture pass a lamp [m]: one over the mean of its inverse, to which
/// light that is scattered near the lamp is proportional. `edge`: of the square around `place`, pixels; `ray`: that of
/// `place`.
double meanMiss(const Camera& camera, const glm::dvec2& place, double edge, const Ray& ray, const glm::dvec3& lamp);

}  // namespace lumulus::lamp
