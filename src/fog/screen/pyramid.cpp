#include "fog/screen/pyramid.h"

#include <algorithm>

namespace lumulus::fog {

namespace {

/// Texels of nothing between levels: taps at a level's border reach a rounding error beyond it.
constexpr int gap = 1;

}  // namespace

shared::LevelPush Pyramid::between(int coarser, int lastUsed, double levelScale) const {
    const Level& fine = levels.at(static_cast<std::size_t>(coarser - 1));
    const Level& coarse = levels.at(static_cast<std::size_t>(coarser));
    const glm::vec2 extent = glm::vec2(levels[0].size) / static_cast<float>(1 << (coarser - 1));
    return {fine.offset, fine.size, coarse.offset,
            coarse.size, extent,    1.0F / glm::vec2(image),
            coarser,     lastUsed,  static_cast<float>(levelScale)};
}

Pyramid makePyramid(const glm::ivec2& size) {
    Pyramid pyramid;
    pyramid.levels.push_back({glm::ivec2(0), size});
    const int along = size.x >= size.y ? 0 : 1;
    const int across = 1 - along;
    glm::ivec2 offset(0);
    offset[across] = size[across] + gap;
    pyramid.image = size;
    do {
        const glm::ivec2 half = (pyramid.levels.back().size + 1) / 2;
        const int axis = pyramid.levels.size() == 1 ? along : across;
        pyramid.levels.push_back({offset, half});
        pyramid.image = glm::max(pyramid.image, offset + half);
        offset[axis] += half[axis] + gap;
    } while (pyramid.levels[pyramid.levels.size() - 2].size != glm::ivec2(1));
    return pyramid;
}

PyramidStep pyramidStep(int filterSize, scene::FogFetch fetch) {
    const bool cubic = fetch != scene::FogFetch::bilinear;
    const double up = cubic ? 4.0 / 3.0 : 0.75;
    if (filterSize == 2) return {1, cubic, 0.25 + up};
    if (filterSize == 6) return {3, cubic, 1.25 + up};
    return {2, cubic, 0.77 + up};
}

int levelsFor(double largest, const PyramidStep& step, int last) {
    const auto variance = static_cast<float>(std::min(largest * largest, 1e30));
    int level = 0;
    while (level < last && shared::levelVariance(static_cast<float>(step.variance), level) < variance) ++level;
    return level;
}

}  // namespace lumulus::fog
