#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <vector>

#include "render/new_fog.h"
#include "scene/scene.h"

namespace lumulus {

/// What of a scene has changed while its renderer lived: what another renderer of as many clouds can take over.
struct SceneChanges {
    scene::Sun sun;                           ///< of now
    std::vector<double> extinctions;          ///< of now, of all clouds [1/m]
    glm::dvec3 wind{0.0};                     ///< [m/s]
    std::map<std::size_t, glm::dvec3> moved;  ///< ways of the clouds that do not lie where the scene has them [m]
    std::shared_ptr<const NewFog> fog;        ///< of now; null: the scene's
};

}  // namespace lumulus
