#include "prefilter/cube_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace lumulus::prefilter {

namespace {

constexpr int faces = 6;

/// A point of a face: −1 to 1 along both edges.
struct FacePlace {
    int face = 0;
    glm::vec2 place{0.0F};
};

/// Faces: +X −X +Y −Y +Z −Z; the edges of each go along the two other axes.
glm::dvec3 onCube(int face, const glm::dvec2& place) {
    const int axis = face / 2;
    glm::dvec3 point;
    point[axis] = face % 2 == 0 ? 1.0 : -1.0;
    point[(axis + 1) % 3] = place.x;
    point[(axis + 2) % 3] = place.y;
    return point;
}

FacePlace placeOf(const glm::vec3& d) {
    const glm::vec3 size = glm::abs(d);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    return {2 * axis + (d[axis] < 0.0F ? 1 : 0), glm::vec2(d[(axis + 1) % 3], d[(axis + 2) % 3]) / size[axis]};
}

double middle(int texel, int size) {
    return (2.0 * texel + 1.0) / size - 1.0;
}

/// Mean of what the panorama has in a texel.
glm::vec4 meanOf(const Panorama& panorama, int face, int x, int y, int size) {
    constexpr int across = 4;
    glm::vec3 sum(0.0F);
    for (int i = 0; i < across * across; ++i) {
        const glm::dvec2 place(middle(across * x + i % across, across * size),
                               middle(across * y + i / across, across * size));
        sum += panorama.at(glm::normalize(onCube(face, place)));
    }
    return {sum / static_cast<float>(across * across), 0.0F};
}

/// Solid angle of a texel by that of one in the middle of a face.
float solidAngle(int x, int y, int size) {
    const double u = middle(x, size), v = middle(y, size);
    return static_cast<float>(std::pow(1.0 + u * u + v * v, -1.5));
}

}  // namespace

glm::vec4 CubeMap::Level::at(int face, const glm::vec2& p) const {
    const auto edge = static_cast<float>(size);
    const float x = (p.x + 1.0F) * 0.5F * edge + 0.5F, y = (p.y + 1.0F) * 0.5F * edge + 0.5F;  // counted with the rim
    const int left = std::min(static_cast<int>(x), size), upper = std::min(static_cast<int>(y), size);
    const glm::vec4* values = texels.data() + place(face, left - 1, upper - 1);
    const glm::vec4* below = values + size + 2;
    const float right = x - static_cast<float>(left), down = y - static_cast<float>(upper);
    const glm::vec4 above = values[0] + right * (values[1] - values[0]);
    return above + down * (below[0] + right * (below[1] - below[0]) - above);
}

/// What lies beyond an edge is nearest to the middle of a texel of the face beside it.
void CubeMap::fillRim(Level& level) {
    const int size = level.size;
    const Level inner = level;
    const auto texel = [size](float p) {
        return std::clamp(static_cast<int>((p + 1.0F) * 0.5F * static_cast<float>(size)), 0, size - 1);
    };
    for (int face = 0; face < faces; ++face)
        for (int y = -1; y <= size; ++y)
            for (int x = -1; x <= size; x += y < 0 || y == size ? 1 : size + 1) {
                const FacePlace at = placeOf(glm::vec3(onCube(face, {middle(x, size), middle(y, size)})));
                level.texels[level.place(face, x, y)] =
                    inner.texels[inner.place(at.face, texel(at.place.x), texel(at.place.y))];
            }
}

CubeMap::Level CubeMap::smaller(const Level& level) {
    Level half{level.size / 2, {}};
    half.texels.resize(half.place(faces, -1, -1));
    for (int face = 0; face < faces; ++face)
        for (int y = 0; y < half.size; ++y)
            for (int x = 0; x < half.size; ++x) {
                glm::vec4 sum(0.0F);
                float shares = 0.0F;
                for (int i = 0; i < 4; ++i) {
                    const int from = 2 * x + i % 2, row = 2 * y + i / 2;
                    const float share = solidAngle(from, row, level.size);
                    sum += share * level.texels[level.place(face, from, row)];
                    shares += share;
                }
                half.texels[half.place(face, x, y)] = sum / shares;
            }
    fillRim(half);
    return half;
}

CubeMap::CubeMap(const Panorama& panorama, int size, const Check& check) : size_(size) {
    assert(size >= 1 && std::has_single_bit(static_cast<unsigned>(size)));
    Level whole{size, {}};
    whole.texels.resize(whole.place(faces, -1, -1));
    tbb::parallel_for(0, faces * size, [&](int row) {
        check();
        for (int x = 0; x < size; ++x)
            whole.texels[whole.place(row / size, x, row % size)] = meanOf(panorama, row / size, x, row % size, size);
    });
    fillRim(whole);
    levels_.push_back(std::move(whole));
    while (levels_.back().size > 1) levels_.push_back(smaller(levels_.back()));
}

glm::vec3 CubeMap::at(const glm::vec3& direction, float level) const {
    const FacePlace p = placeOf(direction);
    const float held = std::clamp(level, 0.0F, static_cast<float>(levels() - 1));
    const auto finer = static_cast<std::size_t>(held);
    const float rest = held - static_cast<float>(finer);
    const glm::vec4 value = levels_[finer].at(p.face, p.place);
    if (rest == 0.0F) return glm::vec3(value);
    return glm::vec3(value + rest * (levels_[finer + 1].at(p.face, p.place) - value));
}

}  // namespace lumulus::prefilter
