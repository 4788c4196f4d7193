#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "prefilter/cube_map.h"
#include "prefilter/panorama.h"

namespace lumulus::environment {

enum class Method {
    sampling,  ///< GGX by filtered importance sampling
    thesis     ///< means over cones (Moschos 2017)
};

/// A map for surfaces of one roughness.
struct Level {
    double roughness = 0.0;  ///< 0 a mirror, 1 matte; alpha of GGX is its square
    int size = 1;            ///< pixels along an edge of a face
};

/// Levels of a map whose finest faces have `size` pixels along an edge, half as many in each further one. Their
/// roughness goes from 0 to 1 in equal steps, or is given. The thesis has its own eleven. Errors: InputError where
/// there are more levels than sizes, or `roughness` does not rise within 0 to 1; it names --levels or --roughness.
std::vector<Level> levelsOf(Method method, int size, int count, std::span<const double> roughness);

/// Levels that leave 16 pixels along an edge of the coarsest, 5 for 256: smaller faces show their texels.
int defaultLevels(int size);

/// Filters a panorama for levels.
class LevelFilter {
  public:
    /// `size`: of the finest level. Errors: what `check` throws, on any thread.
    LevelFilter(Method method, const prefilter::Panorama& panorama, int size, const Check& check);

    /// What a level has in these directions, in their order. Deterministic. Errors: what `check` throws, on any thread.
    std::vector<glm::vec3> filtered(const Level& level, std::span<const glm::vec3> directions) const;

  private:
    Method method_;
    prefilter::CubeMap cube_;
    Check check_;
};

}  // namespace lumulus::environment
