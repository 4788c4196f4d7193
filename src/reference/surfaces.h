#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "scene/surface.h"
#include "view/camera.h"

namespace lumulus::reference {

/// The first surface on a ray.
struct SurfaceHit {
    double metres = 0.0;
    std::size_t surface = 0;
};

/// The opaque surfaces of a scene. A ray that leaves a surface knows the surface's index, so that it does not meet it
/// again by rounding and no smallest distance is needed.
class Surfaces {
  public:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    explicit Surfaces(const std::vector<scene::Surface>& surfaces) : surfaces_(surfaces) {}

    bool empty() const { return surfaces_.empty(); }
    std::size_t size() const { return surfaces_.size(); }
    const scene::Surface& operator[](std::size_t surface) const { return surfaces_[surface]; }

    /// The nearest surface in front of the ray's origin, which lies on the surface `from` (or on none).
    std::optional<SurfaceHit> nearest(const Ray& ray, std::size_t from) const;

    /// True if the ray meets any surface.
    bool block(const Ray& ray, std::size_t from) const { return !surfaces_.empty() && nearest(ray, from).has_value(); }

    /// The unit normal at a point of the surface, on the side that `direction` comes from.
    glm::dvec3 normalAgainst(const glm::dvec3& direction, const glm::dvec3& point, std::size_t surface) const;

  private:
    std::vector<scene::Surface> surfaces_;
};

}  // namespace lumulus::reference
