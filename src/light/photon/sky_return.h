#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "light/photon/air_light.h"
#include "medium/scattering_medium.h"

namespace lumulus::photon {

/// Light of the sky that a backward peak sends to and fro along a line of sight, in the bands above those of the
/// collectors. They cannot hold a bright horizon, and such a medium sends it back nearly as sharp as it is. Sharp light
/// stays on its line, so that two streams on it are the whole transport: for each band of the sky the reflectance and
/// the transmittance of a layer that sends the share |χ_l| of what it scatters straight back (Schuster 1905).
struct SkyReturn {
    glm::dmat3 axes{1.0};  ///< from the sky's frame (first column, up, a quarter on) to the world
    /// By direction of view and optical depth, as shared/sky_return.h has them [W/(m² sr)]: azimuth fastest.
    std::vector<glm::vec4> texels;
    static glm::ivec3 size();
};

/// Whether a medium has such a peak.
bool returnsSky(const phase::ScatteringMedium& medium);

/// Of a medium that has one, in that sky.
SkyReturn makeSkyReturn(const AirLight& air, const phase::ScatteringMedium& medium);

}  // namespace lumulus::photon
