#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/lamp_light.h"
#include "reference/random.h"
#include "scene/surface.h"

namespace lumulus::reference {

/// A direction to a lamp.
struct LampSample {
    std::size_t surface = 0;
    glm::dvec3 direction{0.0};
    double density = 0.0;  ///< of this direction in the choice of all lamps, 1/sr
};

/// The lamps and emitting spheres of a scene as light sources to aim at, since small ones are hardly met by chance. A
/// lamp is chosen by its light over the square of its distance, among those that send light to the point, then a
/// direction within its disc.
class Lamps {
  public:
    /// `lamps`: of the scene; those that shine stand behind all others in `surfaces`, in their order.
    explicit Lamps(const std::vector<scene::Surface>& surfaces, const std::vector<scene::Lamp>& lamps = {});

    bool empty() const { return lamps_.empty(); }

    std::optional<LampSample> sample(const glm::dvec3& point, Random& random) const;

    /// What a surface sends into a direction, W·m⁻²·sr⁻¹.
    glm::dvec3 emission(std::size_t surface, const glm::dvec3& direction) const;

    /// Density with which `sample` draws a direction to the lamp `surface`, 1/sr; 0 if the surface is no lamp.
    double density(const glm::dvec3& point, std::size_t surface) const;

  private:
    struct Lamp {
        std::size_t surface;
        glm::dvec3 middle;
        double radius;
        double light;                   ///< sum of the channels of its radiance at most, times the radius's square
        std::optional<LampLight> beam;  ///< of a lamp of the scene

        double weightAt(const glm::dvec3& point) const;
    };

    double weightAt(const glm::dvec3& point) const;

    std::vector<scene::Surface> surfaces_;
    std::size_t firstBeam_;  ///< the first surface that is a lamp of the scene
    std::vector<Lamp> lamps_;
    std::vector<LampLight> beams_;
};

/// Surfaces with a black sphere for each lamp that shines, in order.
std::vector<scene::Surface> withLamps(std::vector<scene::Surface> surfaces, const std::vector<scene::Lamp>& lamps);

}  // namespace lumulus::reference
