#pragma once

#include <span>
#include <vector>

#include "lamp/haze.h"
#include "lamp/lamp_tree.h"
#include "lamp/ray_bundle.h"
#include "scene/sky.h"

namespace lumulus::lamp {

/// The lamps, or groups of lamps, that bring a part of a picture its light.
struct SeenLamps {
    std::vector<NodeLight> nodes;
    double light = 0.0;  ///< luminance of all at the middle, with what was done; 0 where the rays are not narrow

    /// Luminance of a node over that of all.
    double share(const NodeLight& node) const { return light > 0.0 ? node.bound / light : 1.0; }
};

/// Lamps of groups whose light fog scatters once into a bundle of rays. `done`: luminance there of lamps that are not
/// asked for; the error of groups is a share of both.
SeenLamps lampsInFog(std::span<const LampNode* const> groups, const Haze& haze, const RayBundle& rays, double done);

/// Lamps as a part of a picture sees them. The lamps of the tree, and the haze, outlive it.
class LampsAlong {
  public:
    /// `rays`: all that the part is seen by.
    LampsAlong(const LampTree& tree, const Haze& haze, const RayBundle& rays);

    /// Groups of point lamps in no shade, whose light is smooth, and of the others.
    const std::vector<const LampNode*>& smooth() const { return smooth_; }
    const std::vector<const LampNode*>& others() const { return others_; }
    /// Lamps whose light clouds or fog may scatter into the rays.
    SeenLamps amongClouds() const;

    /// What the ground, a plane, reflects where one of the rays meets it after `metres`, as it is seen [W/(m² sr)].
    glm::dvec3 onGround(const scene::Ground& ground, const Ray& ray, double metres) const;

  private:
    const Haze& haze_;
    RayBundle rays_;
    std::vector<const LampNode*> groups_, smooth_, others_;  ///< that may light the rays
};

}  // namespace lumulus::lamp
