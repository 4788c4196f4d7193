#pragma once

#include <memory>
#include <optional>
#include <span>

#include "light/photon/carried_light.h"
#include "light/photon/traced_sums.h"
#include "render/world.h"
#include "scene/scene.h"

namespace lumulus {

/// Light of the photons of one frame, for the one behind it: a value on the host.
struct FrameLight {
    photon::CarriedPlan plan;
    photon::TracedSums sums;
};

/// Of a world without a ring, which is made of `scene`; none where no photon is of use. The sums are those of the map.
std::optional<FrameLight> frameLightOf(gpu::Context& context, World& world, const scene::Scene& scene);

/// Adds the light of the frame before to what was traced, as that of so many generations more. `ways` of the clouds of
/// the scene. Returns whether there was any to add. Errors: Error where interrupted.
bool carryLight(gpu::Context& context, World& world, const scene::Scene& scene, const FrameLight& before,
                std::span<const photon::Way> ways, int generations);

}  // namespace lumulus
