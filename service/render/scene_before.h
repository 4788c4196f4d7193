#pragma once

#include <optional>
#include <vector>

#include "render/frame_light.h"
#include "render/renderer.h"
#include "render/scene_changes.h"
#include "render/shown_densities.h"
#include "scene/scene.h"
#include "service/render/cost_model.h"
#include "service/render/noise.h"
#include "service/telemetry/memory_budget.h"
#include "view/view.h"

namespace lumulus::service {

/// What a scene that gets another density goes on with: a value on the host.
struct SceneBefore {
    scene::Scene scene;  ///< as it was loaded
    SceneChanges changes;
    std::optional<FrameLight> light;  ///< none where no photon is of use
    NoiseEstimate noise;
    CostModel costs;
    std::vector<View> views;       ///< that were drawn last
    int reduction = 1;             ///< of them
    double time = 0.0;             ///< of the wind [s]
    MemoryBudget::Share memory{};  ///< of the light, and of as much that it becomes
};

/// Densities of a scene, for one that shows some of them too: values on the host.
struct DensitiesBefore {
    DensityCopies copies;
    MemoryBudget::Share memory;  ///< of the copies
};

/// Goes on with the light of before in the renderer of `now`, whose clouds are those of before with other densities,
/// along their motion: that of a sequence, or by `seconds` (above 0) at the velocities of the new file. Returns whether
/// there was any light to go on with. Errors: those of motionBetween(), what `check` throws.
bool goOn(Renderer& renderer, const scene::Scene& now, const SceneBefore& before, double seconds, const Check& check);

}  // namespace lumulus::service
