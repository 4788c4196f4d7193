#pragma once

#include "render/renderer.h"
#include "scene/scene.h"
#include "service/render/media_source.h"
#include "service/values/results.h"

namespace lumulus::service {

/// What clients are told of a scene that is loaded, under a light.
SceneDescription describeScene(const scene::Scene& scene, const Renderer& renderer, const SceneLight& light);

/// Notes scene, seed, program and photons in the attributes of a picture.
void describePicture(LayeredImage& image, const scene::Scene& scene, const Renderer& renderer);

/// What `render` needs to make the same picture as the renderer does now, as values of --set. `media`: keys of fog
/// that have changed.
std::vector<std::string> repeatOverrides(const scene::Scene& scene, const Renderer& renderer, const MediaKeys& media);

}  // namespace lumulus::service
