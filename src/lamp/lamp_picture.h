#pragma once

#include <optional>
#include <vector>

#include "base/image.h"
#include "base/interrupt.h"
#include "lamp/clouds.h"
#include "lamp/solids.h"
#include "scene/scene.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::lamp {

/// What is around the lamps of a picture.
struct Surroundings {
    const std::vector<scene::Lamp>& lamps;
    const scene::Fog& fog;
    std::optional<scene::Ground> ground;  ///< a plane
    int paths = 0;                        ///< paths of light that is scattered more than once; 0: none
    std::uint64_t seed = 1;
    std::vector<Cloud> clouds{};
    const Solids* solids = nullptr;  ///< null: there is none
    bool discs = true;               ///< whether lamps themselves are seen
};

/// Adds the light of lamps to the part `tile` of a picture: their discs, what the ground reflects of them, and what fog
/// and clouds scatter of them towards the eye. Errors: what `check` throws.
void addLamps(LayeredImage& image, const Camera& camera, const Tile& tile, const Surroundings& around,
              const Check& check);

}  // namespace lumulus::lamp
