#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/fog.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::fog {

/// What is seen, pixel by pixel from the upper left corner of a part of the picture, where no cloud is. A list of one
/// value stands for all pixels.
struct OpenSky {
    std::vector<glm::vec4> sky;  ///< RGB: what is left of the sky's radiance behind all fog
    std::vector<glm::vec4> own;  ///< RGB: the fog's own radiance
};

/// The sky of the same radiance everywhere through all fog. Pixels differ only where a medium absorbs or emits: rays
/// and exponentials are then taken on the host, in doubles.
OpenSky openSky(const scene::Fog& fog, const Camera& camera, const glm::vec3& sky, const Tile& part);

}  // namespace lumulus::fog
