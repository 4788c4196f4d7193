#pragma once

#include "render/renderer.h"
#include "scene/scene.h"
#include "service/values/results.h"

namespace lumulus::service {

/// What clients are told of a scene that is loaded, under a light.
SceneDescription describeScene(const scene::Scene& scene, const Renderer& renderer, const SceneLight& light);

}  // namespace lumulus::service
