#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "prefilter/panorama.h"
#include "render/ambient.h"
#include "render/renderer.h"
#include "scene/scene.h"

/// A scene's light around a point, for programs that light things with it.
namespace lumulus::environment {

/// A sun or moon that is given apart from the map.
struct Luminary {
    std::string name;  ///< "sun" or "moon"
    glm::dvec3 directionTo{0.0, 1.0, 0.0};
    double angularRadius = 0.0;       ///< degrees
    glm::dvec3 irradianceInAir{0.0};  ///< on a plane that faces it, through the air alone [W/m²]; as `lumulus sky`
    glm::dvec3 transmittance{1.0};    ///< of clouds, fog and ground on the way, by channel

    glm::dvec3 irradiance() const { return irradianceInAir * transmittance; }
};

struct Surroundings {
    glm::dvec3 point{0.0};
    prefilter::Panorama panorama;  ///< radiance [W/(m² sr)]
    AmbientLight harmonics;        ///< of the panorama
    std::vector<Luminary> lights;
    bool discsInMap = false;  ///< whether the panorama shows the discs of the lights, too
};

/// The scene as a renderer for drawSurroundings() needs it: seen from a point, by a panorama of 4 × 2 pixels for each
/// pixel along the edge of a cube's face. Errors: InputError where the point is below the ground; `option` names it.
scene::Scene sceneAround(scene::Scene scene, const glm::dvec3& point, int size, const std::string& option);

/// Draws what surrounds the point of a scene that sceneAround() has made, with its photons traced. `discs`: whether the
/// panorama shows sun and moon. Errors: those of Renderer::draw; what `check` throws.
Surroundings drawSurroundings(Renderer& renderer, const scene::Scene& scene, bool discs, const Check& check);

}  // namespace lumulus::environment
