#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/air_medium.h"
#include "reference/haze_collision.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "scene/fog.h"
#include "view/camera.h"

namespace lumulus::reference {

/// The fog media of a scene together, for light of three channels or of four wavelengths. The first collision of each
/// medium is found by the inverse of its integral, and the nearest one counts.
template <typename Light>
class FogMedia {
  public:
    struct Medium {
        scene::FogMedium shape;
        Light scattering;  ///< 1/m at ϱ = 1
        Light extinction;
        Light emission;  ///< W/(m³ sr) at ϱ = 1
        PhaseFunction phase;
    };
    using Spread = std::function<Light(const glm::dvec3&)>;

    /// None.
    FogMedia() = default;

    /// `coefficient`, `emission`: what stands for an RGB triple of the scene. `planet`: as for FogOnRay.
    FogMedia(const scene::Fog& fog, const Spread& coefficient, const Spread& emission,
             const std::optional<double>& planet);

    bool empty() const { return media_.empty(); }
    const Medium& operator[](std::size_t medium) const { return media_[medium]; }

    Light opticalDepth(const Ray& ray, double metres) const;

    /// The first collision before `limit` metres of a path that is drawn for one channel.
    std::optional<HazeCollision> collide(const Ray& ray, double limit, int channel, Random& random) const;

    /// Estimates the radiance that the fog emits up to `metres`. `passed(point)` is the throughput of a path that
    /// reached a point, as it was drawn.
    Light emitted(const Ray& ray, double metres, const std::function<Light(double)>& passed, Random& random) const;

  private:
    std::vector<Medium> media_;
    std::optional<double> planet_;
};

extern template class FogMedia<glm::dvec3>;
extern template class FogMedia<Four>;

}  // namespace lumulus::reference
