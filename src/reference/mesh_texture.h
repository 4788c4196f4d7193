#pragma once

#include <glm/glm.hpp>

#include "mesh/model.h"

namespace lumulus::reference {

/// What a texture has at a place, linear between the middles of pixels. Colours of sRGB become linear before.
glm::dvec4 textureAt(const mesh::Texture& texture, const glm::dvec2& uv, bool srgb);

/// Whether a place of a surface with an alpha mask has a surface.
bool isThere(const mesh::Model& model, const mesh::Material& material, const glm::dvec2& uv);

}  // namespace lumulus::reference
