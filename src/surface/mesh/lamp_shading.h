#pragma once

#include <vector>

#include "lamp/beam.h"
#include "lamp/clouds.h"
#include "lamp/haze.h"
#include "scene/fog.h"
#include "surface/material/energy.h"
#include "surface/mesh/mesh_surface.h"

namespace lumulus::surface {

/// The lamps of a scene as meshes reflect them: points whose light falls with the square of the distance and comes
/// through fog and clouds, where no mesh stands before them.
class LampShading {
  public:
    /// `eye`: place near which the fog is seen. `scene` outlives this object.
    LampShading(const MeshScene& scene, const std::vector<scene::Lamp>& lamps, const scene::Fog& fog,
                const glm::dvec3& eye, std::vector<lamp::Cloud> clouds);

    /// Radiance that a point sends of it into a direction [W/(m² sr)].
    glm::dvec3 at(const MeshPoint& point, const glm::dvec3& toEye, const material::EnergyTable& energy) const;

  private:
    const MeshScene& scene_;
    lamp::Haze haze_;
    lamp::Clouds clouds_;
    std::vector<lamp::Beam> beams_;
};

/// Meshes as they stand in the light of lamps. `scene` outlives the result.
lamp::Solids solidsOf(const MeshScene& scene);

}  // namespace lumulus::surface
