#pragma once

#include <glm/glm.hpp>

#include "mesh/model.h"

namespace lumulus::surface {

/// A texture at a place, bilinear; `srgb`: its colours become linear. Places are wrapped as the texture says.
glm::vec4 sampleTexture(const mesh::Texture& texture, const glm::vec2& uv, bool srgb);

}  // namespace lumulus::surface
