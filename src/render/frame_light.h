#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "light/photon/carried_light.h"
#include "light/photon/traced_sums.h"
#include "render/world.h"
#include "scene/scene.h"
#include "vdb/read_limits.h"

namespace lumulus {

/// Light of the photons of one frame, for the one behind it: a value on the host.
struct FrameLight {
    photon::CarriedPlan plan;
    photon::TracedSums sums;
    double radius = 0.0;  ///< of all clouds [m]
};

/// How what is in the clouds of a scene has moved since the frame before.
struct FrameMotion {
    bool goesOn = true;             ///< false: another piece of a sequence begins in one of them
    bool known = true;              ///< false: the density of one changes, and nothing is known of velocities
    std::vector<photon::Way> ways;  ///< of the clouds, as CloudMotion::way
};

/// From the scene of `light` to one of as many clouds. Errors: those of motionBetween().
FrameMotion motionOf(const FrameLight& light, const scene::Scene& before, const scene::Scene& now,
                     const vdb::ReadLimits& limits);

/// Of a world that is made of `scene`; none where no photon is of use. The sums are those of the map.
std::optional<FrameLight> frameLightOf(gpu::Context& context, World& world, const scene::Scene& scene);

/// Bytes of frameLightOf().
std::uint64_t frameLightBytes(const World& world);

/// Adds the light of the frame before to what was traced, as that of so many generations more. `ways` of the clouds of
/// the scene. Returns whether there was any to add. Not with a ring. Errors: Error where interrupted.
bool carryLight(gpu::Context& context, World& world, const scene::Scene& scene, const FrameLight& before,
                std::span<const photon::Way> ways, int generations);

/// Goes on with the ring of the scene before, in which each generation then has the mean light of all of them, so that
/// new ones take their places one by one. Clouds that had no light get theirs from the new ones alone. Returns whether
/// there was any light. Before the first generation of a world with a ring. Errors: what `check` throws.
bool carryRing(gpu::Context& context, World& world, const scene::Scene& scene, const FrameLight& before,
               std::span<const photon::Way> ways, const Check& check);

}  // namespace lumulus
