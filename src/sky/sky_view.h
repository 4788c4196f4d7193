#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "shared/sky_view.h"
#include "sky/atmosphere.h"
#include "view/camera.h"

namespace lumulus::sky {

/// The sky as one point sees it: tables for shaders/shared/sky_view.h, Rec. 709 in W/(m² sr).
struct SkyView {
    shared::SkyViewParams params{};
    std::vector<glm::vec4> scattered, aerosol;  ///< row by row
    std::vector<glm::vec4> transmittance;       ///< by row, where there is a floor
};

/// Makes the tables for an eye. Errors: InputError where it lies below the ground.
SkyView makeSkyView(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun);
/// The same where rays end at the height `floor` above the ground, and what is there is not seen: `transmittance` has
/// how much of it would be. An eye that lies lower counts as being there. `scale`: factor of what comes from above the
/// floor's horizon, by the sine of elevation and by the azimuth from the sun's.
SkyView makeSkyViewAbove(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun, double floor,
                         const std::function<glm::dvec3(double, double)>& scale = {});
/// What a shader is given where the sun has gone round the upward direction since the tables were made.
void turnTo(shared::SkyViewParams& params, const glm::dvec3& up, const glm::dvec3& toSun);
/// Radiance in a direction, bilinear in the tables.
glm::dvec3 radianceOf(const SkyView& view, const glm::dvec3& direction);
/// Transmittance in a direction down to the floor.
glm::dvec3 transmittanceOf(const SkyView& view, const glm::dvec3& direction);

/// The air between the eye of a picture and what is seen in it, up to some distances: RGB of what it adds and of what
/// it lets through, by place in the picture and by distance. A `coarse` one has a
/// quarter of the texels.
struct AirBetween {
    glm::ivec3 size{1};
    double nearest = 0.0, farthest = 1.0;  ///< metres, of the first and of the last slice
    std::vector<glm::vec4> light{glm::vec4(0.0F)}, transmittance{glm::vec4(1.0F)};
};
/// Where there is a floor, only the air above it counts.
AirBetween makeAirBetween(const Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                          double farthest, std::optional<double> floor = {}, bool coarse = false);

}  // namespace lumulus::sky
