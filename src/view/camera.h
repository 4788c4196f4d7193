#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "view/bounds.h"

namespace lumulus {

/// A half line in the world; the direction is a unit vector.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};
};

/// Where a picture is seen from: geometry only, shared by every renderer. World coordinates, metres.
struct Camera {
    glm::dvec3 position{0.0};
    glm::dmat3 axes{1.0};      ///< columns: right, up, forward; orthonormal (forward = up × right)
    double tanHalfFov = 1.0;   ///< of the picture's height (perspective)
    double pixelAspect = 1.0;  ///< width of a pixel over its height (perspective)
    glm::dvec2 middle{0.0};  ///< tangents of the picture's middle: not zero where the frustum is off axis (perspective)
    scene::Projection projection = scene::Projection::perspective;
    double orthographicHeight = 1.0;  ///< metres from the lower to the upper edge
    int width = 1;                    ///< pixels
    int height = 1;

    /// The ray through a point of the picture: pixel coordinates from the upper left corner, so that pixel (x, y) is
    /// [x, x+1] × [y, y+1]. A panorama is equirectangular over the full sphere: forward in the middle, right a quarter
    /// of the width to the right of it, `up` at the upper edge; its
    /// middle row is level (square to `up`), whatever the target.
    Ray ray(double px, double py) const;
};

/// The camera of a scene. What the scene leaves open is chosen so that the cloud fills the picture: the target is the
/// middle of the cloud; the position lies 20° to the right of +Z from the target and 5° below it, which is level with
/// the lower third of a cumulus, at the distance where the cloud takes 90 % of the picture's width or
/// height, whichever it meets first. Where `up` is along the view, north (−Z) takes its place, and +Y where that is
/// too. Errors: InputError where position and target are the same point.
Camera makeCamera(const scene::Camera& camera, const scene::Image& image, const Bounds& cloud);

}  // namespace lumulus
