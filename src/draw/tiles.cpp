#include "draw/tiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "draw/lattice.h"

namespace lumulus::draw {

namespace {

/// Tiles along the edge of a group, which is filtered first: a power of two.
constexpr int groupEdge = 16;

/// A billboard as the beams look at it, a little larger.
struct Target {
    glm::dvec3 centre{0.0}, direction{0.0};
    double radius = 0.0;
    double sine = 1.0, cosine = 0.0;  ///< of the half angle that it takes from the eye; 1: the eye is in it

    explicit Target(const shared::Billboard& billboard)
        : centre(billboard.centre), radius(static_cast<double>(billboard.radius) * (1.0 + 1e-5)) {
        const double distance = glm::length(centre);
        if (distance <= radius) return;
        direction = centre / distance;
        sine = radius / distance;
        cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    }
};

/// All rays of a rectangle of pixels lie in it: a cone from the eye, or (orthographic) a cylinder along the view.
class Beam {
  public:
    Beam(const Camera& camera, glm::ivec2 lower, glm::ivec2 upper) : parallel_(isParallel(camera)) {
        upper = glm::min(upper, glm::ivec2(camera.width, camera.height) + (widestSpacing - 1));
        const Ray middle = camera.ray(0.5 * (lower.x + upper.x), 0.5 * (lower.y + upper.y));
        axis_ = middle.direction;
        origin_ = middle.origin - camera.position;
        // The widest ray leaves at a corner; where the projection bends lines, anywhere along the border.
        const int along = camera.projection == scene::Projection::panorama ? 8 : 1;
        for (int i = 0; i <= along; ++i)
            for (int j = 0; j <= along; ++j) {
                if (i % along != 0 && j % along != 0) continue;
                const glm::dvec2 share = glm::dvec2(i, j) / static_cast<double>(along);
                const glm::dvec2 place = glm::dvec2(lower) + share * glm::dvec2(upper - lower);
                const Ray ray = camera.ray(place.x, place.y);
                width_ = std::max(width_, parallel_ ? glm::length(ray.origin - middle.origin) : angle(ray.direction));
            }
        width_ *= 1.0 + 1e-4;
        if (parallel_) return;
        width_ += 1e-6;
        cosWidth_ = std::cos(width_);
        sinWidth_ = std::sin(width_);
        widest_ = width_ >= 0.5 * std::numbers::pi;
    }

    bool mayMeet(const Target& target) const {
        if (parallel_) {
            const glm::dvec3 centre = target.centre - origin_;
            const double along = glm::dot(centre, axis_);
            return along > -target.radius && glm::length(centre - along * axis_) < target.radius + width_;
        }
        // the cosine of the sum of both half angles
        return target.sine >= 1.0 || widest_ ||
               glm::dot(axis_, target.direction) >= cosWidth_ * target.cosine - sinWidth_ * target.sine;
    }

  private:
    bool parallel_;
    glm::dvec3 axis_{0.0};
    glm::dvec3 origin_{0.0};
    double width_ = 0.0;  // radians, or metres
    double cosWidth_ = 1.0, sinWidth_ = 0.0;
    bool widest_ = false;  // half of all directions and more: the sum of two half angles may be beyond π

    static bool isParallel(const Camera& camera) { return camera.projection == scene::Projection::orthographic; }
    /// Precise also for small angles.
    double angle(const glm::dvec3& direction) const {
        return 2.0 * std::atan2(glm::length(direction - axis_), glm::length(direction + axis_));
    }
};

std::vector<std::uint32_t> keep(const Beam& beam, const std::vector<Target>& targets,
                                const std::vector<std::uint32_t>& candidates) {
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t i : candidates)
        if (beam.mayMeet(targets[i])) kept.push_back(i);
    return kept;
}

/// Fills the lists of a square of tiles, quarter by quarter: most of what one quarter meets none of the others does.
class Divider {
  public:
    Divider(const Camera& camera, const TileLists& tiles, const std::vector<Target>& targets,
            std::vector<std::vector<std::uint32_t>>& lists)
        : camera_(camera), tiles_(tiles), targets_(targets), lists_(lists) {}

    void divide(const glm::ivec2& first, int edge, const std::vector<std::uint32_t>& candidates) const {
        if (first.x >= tiles_.across || first.y >= tiles_.down) return;
        const glm::ivec2 lower = first * shared::TILE_EDGE;
        std::vector<std::uint32_t> kept =
            keep(Beam(camera_, lower, lower + edge * shared::TILE_EDGE), targets_, candidates);
        if (edge == 1) {
            lists_[static_cast<std::size_t>(first.y * tiles_.across + first.x)] = std::move(kept);
            return;
        }
        if (kept.empty()) return;
        const int half = edge / 2;
        for (int i = 0; i < 4; ++i) divide(first + half * glm::ivec2(i % 2, i / 2), half, kept);
    }

  private:
    const Camera& camera_;
    const TileLists& tiles_;
    const std::vector<Target>& targets_;
    std::vector<std::vector<std::uint32_t>>& lists_;
};

}  // namespace

TileLists makeTileLists(const Camera& camera, const std::vector<shared::Billboard>& billboards) {
    TileLists tiles;
    // the last points of a lattice may lie beyond the picture
    tiles.across = (camera.width + widestSpacing - 2) / shared::TILE_EDGE + 1;
    tiles.down = (camera.height + widestSpacing - 2) / shared::TILE_EDGE + 1;
    const auto total = static_cast<std::size_t>(tiles.across) * static_cast<std::size_t>(tiles.down);
    std::vector<std::vector<std::uint32_t>> lists(total);
    const std::vector<Target> targets(billboards.begin(), billboards.end());
    std::vector<std::uint32_t> all(billboards.size());
    std::iota(all.begin(), all.end(), 0U);
    const int groupsAcross = (tiles.across + groupEdge - 1) / groupEdge;
    const int groupsDown = (tiles.down + groupEdge - 1) / groupEdge;
    const Divider divider(camera, tiles, targets, lists);
    tbb::parallel_for(0, groupsAcross * groupsDown, [&](int group) {
        divider.divide(groupEdge * glm::ivec2(group % groupsAcross, group / groupsAcross), groupEdge, all);
    });
    tiles.offsets.push_back(0);
    for (const auto& list : lists) {
        tiles.lists.insert(tiles.lists.end(), list.begin(), list.end());
        tiles.offsets.push_back(static_cast<std::uint32_t>(tiles.lists.size()));
    }
    return tiles;
}

}  // namespace lumulus::draw
