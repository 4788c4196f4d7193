#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/random.h"
#include "scene/surface.h"

namespace lumulus::reference {

/// A direction to a lamp.
struct LampSample {
    std::size_t surface = 0;
    glm::dvec3 direction{0.0};
    double density = 0.0;  ///< of this direction in the choice of all lamps, 1/sr
};

/// The emitting spheres of a scene as light sources to aim at, since small ones are hardly met by chance. A lamp is
/// chosen by its light over the square of its distance, then a direction within its cone.
class Lamps {
  public:
    explicit Lamps(const std::vector<scene::Surface>& surfaces);

    bool empty() const { return lamps_.empty(); }

    std::optional<LampSample> sample(const glm::dvec3& point, Random& random) const;

    /// Density with which `sample` draws a direction to the lamp `surface`, 1/sr; 0 if the surface is no lamp.
    double density(const glm::dvec3& point, std::size_t surface) const;

  private:
    struct Lamp {
        std::size_t surface;
        glm::dvec3 middle;
        double radius;
        double light;  ///< sum of the channels, times the radius's square

        double weightAt(const glm::dvec3& point) const;
    };

    double weightAt(const glm::dvec3& point) const;

    std::vector<Lamp> lamps_;
};

}  // namespace lumulus::reference
