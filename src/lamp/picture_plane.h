#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "view/camera.h"

namespace lumulus::lamp {

/// Directions as places of a picture, in pixels from its upper left corner. Not for orthographic cameras.
class PicturePlane {
  public:
    explicit PicturePlane(const Camera& camera) : camera_(camera) {}

    /// Where a direction from the eye is seen; none beside the picture and a margin of so many pixels around it.
    std::optional<glm::dvec2> placeOf(const glm::dvec3& direction, double margin) const;

    /// Of a square of so many pixels from its upper left corner [sr].
    double solidAngle(const glm::dvec2& corner, double edge) const;

  private:
    Camera camera_;
};

}  // namespace lumulus::lamp
