#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "reference/any_tracer.h"
#include "reference/disc_cover.h"
#include "scene/scene.h"
#include "view/camera.h"

namespace lumulus::reference {

/// Which part of each pixel every shining lamp covers, so that lamps smaller than a pixel are looked at and not met by
/// chance alone.
class LampCovers {
  public:
    LampCovers(const scene::Scene& scene, const Camera& camera);

    /// What a path through this pixel has of the lamps that are seen themselves, W·m⁻²·sr⁻¹. In orthographic pictures
    /// paths meet lamps by chance.
    glm::dvec3 seen(const AnyTracer& tracer, const Camera& camera, const PathSample& path, const glm::ivec2& pixel,
                    Random& random) const;

  private:
    std::vector<DiscCover> covers_;
};

}  // namespace lumulus::reference
