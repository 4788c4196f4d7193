#include "draw/tiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "draw/sparse_sampling.h"

namespace lumulus::draw {

namespace {

/// Tiles along the edge of a group, a power of two: smaller squares are not worth a task of their own, and where the
/// projection does not keep lines straight larger ones have no known beam.
constexpr int groupEdge = 16;

bool isParallel(const Camera& camera) {
    return camera.projection == scene::Projection::orthographic;
}

/// What rays from the eye are told apart by: a point of the unit sphere, its direction; where they are parallel, one in
/// the plane across them [m]. Single precision: sixteen bytes are looked at for each billboard and beam.
struct Disc {
    glm::vec3 middle{0.0F};
    float reach = 0.0F;  ///< straight distance from the middle
};

constexpr float everywhere = 4.0F;  // more than the sphere's diameter
/// What rounding to single precision takes from the reach, as a part of the middle's length.
constexpr double rounding = 1e-6;

Disc discOf(const glm::dvec3& middle, double reach) {
    return {glm::vec3(middle), static_cast<float>(reach + rounding * glm::length(middle))};
}

/// Two of them meet only if it holds: on the sphere, sums of chords are no shorter than the chord of the sum.
bool mayMeet(const Disc& a, const Disc& b) {
    const glm::vec3 apart = a.middle - b.middle;
    const float reach = a.reach + b.reach;
    return glm::dot(apart, apart) <= reach * reach;
}

glm::dvec3 across(const Camera& camera, const glm::dvec3& place) {
    return {glm::dot(place, camera.axes[0]), glm::dot(place, camera.axes[1]), 0.0};
}

/// What a billboard covers; a little larger.
Disc coveredBy(const shared::Billboard& billboard, const Camera& camera) {
    const glm::dvec3 centre(billboard.centre);
    const double radius = static_cast<double>(billboard.radius) * (1.0 + 1e-5);
    if (isParallel(camera)) return discOf(across(camera, centre), radius);
    const double distance = glm::length(centre);
    if (distance <= radius) return {{}, everywhere};
    return discOf(centre / distance, 2.0 * std::sin(0.5 * std::asin(radius / distance)));
}

/// What parallel rays have left behind, which their discs do not tell; of other rays the discs do.
bool isBehind(const shared::Billboard& billboard, const Camera& camera) {
    return isParallel(camera) && glm::dot(glm::dvec3(billboard.centre), camera.axes[2]) <
                                     -(1.0 + 1e-5) * static_cast<double>(billboard.radius);
}

/// Holds all rays of a rectangle of pixels.
Disc beam(const Camera& camera, glm::ivec2 lower, glm::ivec2 upper) {
    upper = glm::min(upper, glm::ivec2(camera.width, camera.height) + (widestSpacing - 1));
    const auto pointOf = [&](double x, double y) {
        const Ray ray = camera.ray(x, y);
        return isParallel(camera) ? across(camera, ray.origin - camera.position) : ray.direction;
    };
    const glm::dvec3 middle = pointOf(0.5 * (lower.x + upper.x), 0.5 * (lower.y + upper.y));
    // The widest ray leaves at a corner; where the projection does not keep lines straight, anywhere along the border.
    const int along = camera.projection == scene::Projection::panorama ? 8 : 1;
    double reach = 0.0;
    for (int i = 0; i <= along; ++i)
        for (int j = 0; j <= along; ++j) {
            if (i % along != 0 && j % along != 0) continue;
            const glm::dvec2 share = glm::dvec2(i, j) / static_cast<double>(along);
            const glm::dvec2 place = glm::dvec2(lower) + share * glm::dvec2(upper - lower);
            reach = std::max(reach, glm::distance(pointOf(place.x, place.y), middle));
        }
    // Beyond a right angle, as in a small panorama, the rays inside of the border may be wider.
    if (!isParallel(camera) && reach >= std::numbers::sqrt2) return {{}, everywhere};
    return discOf(middle, reach * (1.0 + 1e-4));
}

std::vector<std::uint32_t> keep(const Disc& beam, const std::vector<Disc>& targets,
                                const std::vector<std::uint32_t>& candidates) {
    std::vector<std::uint32_t> kept(candidates.size());
    std::size_t count = 0;
    for (const std::uint32_t i : candidates) {
        kept[count] = i;  // no branch: nobody could predict it
        count += mayMeet(beam, targets[i]) ? 1 : 0;
    }
    kept.resize(count);
    return kept;
}

/// Fills the lists of a square of tiles, quarter by quarter: most of what one quarter meets none of the others does.
class Divider {
  public:
    Divider(const Camera& camera, const TileLists& tiles, const std::vector<Disc>& targets,
            std::vector<std::vector<std::uint32_t>>& lists)
        : camera_(camera), tiles_(tiles), targets_(targets), lists_(lists) {}

    void divide(const glm::ivec2& first, int edge, const std::vector<std::uint32_t>& candidates) const {
        if (first.x >= tiles_.across || first.y >= tiles_.down) return;
        const glm::ivec2 lower = first * shared::TILE_EDGE;
        std::vector<std::uint32_t> kept =
            keep(beam(camera_, lower, lower + edge * shared::TILE_EDGE), targets_, candidates);
        if (edge == 1) {
            lists_[static_cast<std::size_t>(first.y * tiles_.across + first.x)] = std::move(kept);
            return;
        }
        if (kept.empty()) return;
        const int half = edge / 2;
        const auto quarter = [&](int i) { divide(first + half * glm::ivec2(i % 2, i / 2), half, kept); };
        if (edge > groupEdge)
            tbb::parallel_for(0, 4, quarter);
        else
            for (int i = 0; i < 4; ++i) quarter(i);
    }

  private:
    const Camera& camera_;
    const TileLists& tiles_;
    const std::vector<Disc>& targets_;
    std::vector<std::vector<std::uint32_t>>& lists_;
};

/// A square with all tiles in it.
int widestEdge(const TileLists& tiles) {
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max({tiles.across, tiles.down, groupEdge}))));
}

}  // namespace

TileLists makeTileLists(const Camera& camera, const std::vector<shared::Billboard>& billboards) {
    TileLists tiles;
    // the last points of a sampling may lie beyond the picture
    tiles.across = (camera.width + widestSpacing - 2) / shared::TILE_EDGE + 1;
    tiles.down = (camera.height + widestSpacing - 2) / shared::TILE_EDGE + 1;
    const auto total = static_cast<std::size_t>(tiles.across) * static_cast<std::size_t>(tiles.down);
    std::vector<std::vector<std::uint32_t>> lists(total);
    std::vector<Disc> targets;
    targets.reserve(billboards.size());
    for (const shared::Billboard& billboard : billboards) targets.push_back(coveredBy(billboard, camera));
    std::vector<std::uint32_t> all;
    all.reserve(billboards.size());
    for (std::uint32_t i = 0; i < billboards.size(); ++i)
        if (!isBehind(billboards[i], camera)) all.push_back(i);
    const int edge = camera.projection == scene::Projection::panorama ? groupEdge : widestEdge(tiles);
    const int groupsAcross = (tiles.across + edge - 1) / edge, groupsDown = (tiles.down + edge - 1) / edge;
    const Divider divider(camera, tiles, targets, lists);
    tbb::parallel_for(0, groupsAcross * groupsDown, [&](int group) {
        divider.divide(edge * glm::ivec2(group % groupsAcross, group / groupsAcross), edge, all);
    });
    tiles.offsets.push_back(0);
    for (const auto& list : lists) {
        tiles.lists.insert(tiles.lists.end(), list.begin(), list.end());
        tiles.offsets.push_back(static_cast<std::uint32_t>(tiles.lists.size()));
    }
    return tiles;
}

}  // namespace lumulus::draw
