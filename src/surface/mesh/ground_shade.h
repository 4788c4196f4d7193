#pragma once

#include "scene/scene.h"
#include "surface/ground_light.h"
#include "surface/mesh/mesh_surface.h"

namespace lumulus::surface {

/// What meshes change in the light that falls on a level ground: their shadows with the penumbra of the sun's disc, the
/// sky that they hide, and the light of sun, sky and ground that they send down, as matte as the mean of their
/// material. `sky`: radiance of the sky, the same everywhere [W/(m² sr)]. `scene` outlives the result. Errors: what
/// `check` throws.
GroundMeshes shadeOnGround(const MeshScene& scene, const scene::Ground& ground, const scene::Sun& sun,
                           const glm::dvec3& sky, const Check& check);

}  // namespace lumulus::surface
