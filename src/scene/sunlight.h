#pragma once

#include <glm/glm.hpp>

namespace lumulus::scene {

/// Irradiance of the sun above the air at its mean distance, W/m² as linear Rec. 709: 132.1 klx.
inline constexpr glm::dvec3 sunAboveAir{210.45, 189.23, 185.23};

}  // namespace lumulus::scene
