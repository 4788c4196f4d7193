#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "scene/fog.h"
#include "shared/fog.h"

namespace lumulus::fog {

/// Where the levels of a pyramid lie in one image, with a texel of nothing between them: the finest in the upper left
/// corner, the next below it (beside it where the picture is higher than wide) and all others beside that one (below
/// it).
struct Pyramid {
    struct Level {
        glm::ivec2 offset{0};
        glm::ivec2 size{0};
    };
    glm::ivec2 image{0};  ///< texels
    std::vector<Level> levels;

    /// Number of the coarsest level that light may stay at: one pixel. Another follows, so that each has a coarser one.
    int last() const { return static_cast<int>(levels.size()) - 2; }
    /// What a pass between the level `coarser` and the one before needs; `lastUsed` is the coarsest of this picture.
    shared::LevelPush between(int coarser, int lastUsed, double levelScale) const;
};

/// All levels of a picture, down to one pixel twice. A level has half the pixels across, rounded up.
Pyramid makePyramid(const glm::ivec2& size);

/// One step of a pyramid: the filter down to half the pixels and the interpolation back up.
struct PyramidStep {
    int pairs = 2;          ///< half the taps across of the filter
    bool cubic = true;      ///< interpolation by cubic B-splines, or linear
    double variance = 2.1;  ///< of both, pixels² of the finer level

    /// c: level k spreads by about c 2^k pixels (the papers' .8 to .86, from what the filters do).
    double scale() const { return std::sqrt(variance / 3.0); }
};

/// `filterSize` is 2, 4 or 6 taps across; the weights stand in lib/pyramid.glsl.
PyramidStep pyramidStep(int filterSize, scene::FogFetch fetch);

/// Number of the coarsest level that light of the spread `largest` [pixels] needs, `last` at most.
int levelsFor(double largest, const PyramidStep& step, int last);

}  // namespace lumulus::fog
