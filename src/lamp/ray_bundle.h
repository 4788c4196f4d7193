#pragma once

#include "lamp/beam.h"
#include "view/camera.h"

namespace lumulus::lamp {

/// Rays around one ray: at a distance along it, they are up to `width` + `spread` · distance away from it [m].
struct RayBundle {
    Ray middle;
    double width = 0.0, spread = 0.0;
    double end = 0.0;  ///< metres

    /// Whether all of the rays see about what their middle sees.
    bool isNarrow() const { return spread < 0.15; }
    double widthAt(double distance) const { return width + spread * (distance > 0.0 ? distance : 0.0); }
};

/// Whether the light of a lamp, or of one up to `off` metres beside it, may meet rays of a bundle. False is certain.
bool mayLight(const Beam& beam, double off, const RayBundle& rays);

/// Distance of a point from the nearest ray of a bundle, at least [m]; 0 among them.
double distanceTo(const RayBundle& rays, const glm::dvec3& point);

}  // namespace lumulus::lamp
