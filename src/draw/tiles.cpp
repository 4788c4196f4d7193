#include "draw/tiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumulus::draw {

namespace {

/// Tiles along the edge of a group, which is filtered first.
constexpr int groupEdge = 8;

/// All rays of a rectangle of pixels lie in it: a cone from the eye, or (orthographic) a cylinder along the view.
class Beam {
  public:
    Beam(const Camera& camera, glm::ivec2 lower, glm::ivec2 upper) : parallel_(isParallel(camera)) {
        upper = glm::min(upper, glm::ivec2(camera.width, camera.height));
        const Ray middle = camera.ray(0.5 * (lower.x + upper.x), 0.5 * (lower.y + upper.y));
        axis_ = middle.direction;
        origin_ = middle.origin - camera.position;
        // The widest ray leaves at the border; the middles of the edges count too where the projection bends lines.
        for (int i = 0; i <= 8; ++i)
            for (int j = 0; j <= 8; ++j) {
                if (i % 8 != 0 && j % 8 != 0) continue;
                const Ray ray =
                    camera.ray(lower.x + (upper.x - lower.x) * i / 8.0, lower.y + (upper.y - lower.y) * j / 8.0);
                width_ = std::max(width_, parallel_ ? glm::length(ray.origin - middle.origin) : angle(ray.direction));
            }
        width_ *= 1.0 + 1e-4;
        width_ += parallel_ ? 0.0 : 1e-6;
    }

    bool mayMeet(const shared::Billboard& billboard) const {
        const glm::dvec3 centre = glm::dvec3(billboard.centre) - origin_;
        const double radius = static_cast<double>(billboard.radius) * (1.0 + 1e-5);
        if (parallel_) {
            const double along = glm::dot(centre, axis_);
            return along > -radius && glm::length(centre - along * axis_) < radius + width_;
        }
        const double distance = glm::length(centre);
        if (distance <= radius) return true;
        return angle(centre / distance) < width_ + std::asin(radius / distance);
    }

  private:
    bool parallel_;
    glm::dvec3 axis_{0.0};
    glm::dvec3 origin_{0.0};
    double width_ = 0.0;  // radians, or metres

    static bool isParallel(const Camera& camera) { return camera.projection == scene::Projection::orthographic; }
    /// Precise also for small angles.
    double angle(const glm::dvec3& direction) const {
        return 2.0 * std::atan2(glm::length(direction - axis_), glm::length(direction + axis_));
    }
};

std::vector<std::uint32_t> keep(const Beam& beam, const std::vector<shared::Billboard>& billboards,
                                const std::vector<std::uint32_t>& candidates) {
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t i : candidates)
        if (beam.mayMeet(billboards[i])) kept.push_back(i);
    return kept;
}

}  // namespace

TileLists makeTileLists(const Camera& camera, const std::vector<shared::Billboard>& billboards) {
    TileLists tiles;
    tiles.across = (camera.width + shared::TILE_EDGE - 1) / shared::TILE_EDGE;
    tiles.down = (camera.height + shared::TILE_EDGE - 1) / shared::TILE_EDGE;
    const auto total = static_cast<std::size_t>(tiles.across) * static_cast<std::size_t>(tiles.down);
    std::vector<std::vector<std::uint32_t>> lists(total);
    std::vector<std::uint32_t> all(billboards.size());
    std::iota(all.begin(), all.end(), 0U);
    const int groupsAcross = (tiles.across + groupEdge - 1) / groupEdge;
    const int groupsDown = (tiles.down + groupEdge - 1) / groupEdge;
    const auto beamOf = [&](int x, int y, int edge) {
        const glm::ivec2 lower = glm::ivec2(x, y) * shared::TILE_EDGE;
        return Beam(camera, lower, lower + edge * shared::TILE_EDGE);
    };
    tbb::parallel_for(0, groupsAcross * groupsDown, [&](int group) {
        const int x0 = group % groupsAcross * groupEdge, y0 = group / groupsAcross * groupEdge;
        const auto candidates = keep(beamOf(x0, y0, groupEdge), billboards, all);
        if (candidates.empty()) return;
        for (int y = y0; y < std::min(y0 + groupEdge, tiles.down); ++y)
            for (int x = x0; x < std::min(x0 + groupEdge, tiles.across); ++x)
                lists[static_cast<std::size_t>(y * tiles.across + x)] = keep(beamOf(x, y, 1), billboards, candidates);
    });
    tiles.offsets.push_back(0);
    for (const auto& list : lists) {
        tiles.lists.insert(tiles.lists.end(), list.begin(), list.end());
        tiles.offsets.push_back(static_cast<std::uint32_t>(tiles.lists.size()));
    }
    return tiles;
}

}  // namespace lumulus::draw
