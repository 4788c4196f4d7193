#pragma once

#include <vector>

#include "shared/sky_view.h"
#include "sky/atmosphere.h"
#include "view/camera.h"

namespace lumulus::sky {

/// The sky as one point sees it: tables for shaders/shared/sky_view.h, Rec. 709 in W/(m² sr).
struct SkyView {
    shared::SkyViewParams params{};
    std::vector<glm::vec4> scattered, aerosol;  ///< row by row
};

/// Makes the tables for an eye. Errors: InputError where it lies below the ground.
SkyView makeSkyView(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun);

/// The air between the eye of a picture and what is seen in it, up to some distances: RGB of what it adds and of what
/// it lets through, by place in the picture and by distance.
struct AirBetween {
    glm::ivec3 size{1};
    double nearest = 0.0, farthest = 1.0;  ///< metres, of the first and of the last slice
    std::vector<glm::vec4> light{glm::vec4(0.0F)}, transmittance{glm::vec4(1.0F)};
};
AirBetween makeAirBetween(const Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                          double farthest);

}  // namespace lumulus::sky
