#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "prefilter/cube_map.h"

namespace lumulus::prefilter {

/// One reading of a cube map for a direction that is filtered, in its frame (z).
struct Reading {
    glm::vec3 towards{0.0F, 0.0F, 1.0F};
    float share = 1.0F;  ///< all of a lobe add up to 1
    float level = 0.0F;  ///< of detail
};

using Lobe = std::vector<Reading>;

/// Samples of a lobe: 256, or 1024 where alpha is 0.1 or more, as wide lobes would be blurred more by each.
std::uint32_t usualSamples(double alpha);

struct LobeOptions {
    std::uint32_t samples = 0;  ///< 0: usualSamples()
    double blur = 1.0;          ///< K: texels of the level that is read have K times the solid angle of a sample
};

/// Filtered importance sampling (Křivánek and Colbert 2008): a lobe of GGX, seen along the normal, by samples of its
/// microfacets, each read at the level of detail whose texels are as large as what the sample stands for. `alpha`: 0 is
/// a mirror, which reads the map as it is at texels of `texel` steradians. `size`: of the cube map's faces.
Lobe ggxLobe(double alpha, int size, double texel, const LobeOptions& options = {});

/// Filters a map for directions (unit vectors), in their order. The threads of oneTBB share the work; their number
/// changes no bit. Errors: what `check` throws, which is asked on any thread.
std::vector<glm::vec3> filtered(const CubeMap& map, const Lobe& lobe, std::span<const glm::vec3> directions,
                                const Check& check);

/// Columns: two unit vectors across a normal, and the normal.
glm::mat3 frameOf(const glm::vec3& normal);

}  // namespace lumulus::prefilter
