#include "lamp/smooth_light.h"

#include <algorithm>
#include <array>
#include <vector>

#include "lamp/mean_miss.h"
#include "lamp/once_scattered.h"
#include "lamp/seen_lamps.h"

namespace lumulus::lamp {

namespace {

/// The square of a square's diagonal over the distance of a lamp from its rays, times the lamp's share of all light,
/// below which the light is interpolated; and the same times the lamp's own light.
constexpr double bentShare = 1.5e-3, bent = 0.04;
/// Diagonal over distance below which the product of light and distance is interpolated, and its error over the square
/// of that and over the distance from the lamp seen from the eye.
constexpr double nearest = 1.0, poleBend = 0.15;
/// Ends of a square's rays are alike where the farthest is up to so many times as far as the nearest: for poles, and in
/// squares larger than a block.
constexpr double levelEnds = 1.05, alikeEnds = 1.25;
/// Distance behind a lamp over the distance at which a ray passes it, from where little of its light comes.
constexpr double past = 4.0;
/// Edge of the smallest squares, and of a block.
constexpr int leastEdge = 4, block = 8;

/// How a lamp's light is interpolated in a square.
enum class Way { plain, pole, none };

/// The corners of a square.
struct Corners {
    std::array<Ray, 4> rays;
    std::array<double, 4> ends{};
    double nearest = 0.0, farthest = 0.0;  ///< of the ends
    bool mixed = false;                    ///< some end in the open and others do not

    Corners(const LitPicture& picture, const Square& square) {
        int open = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec2 place = glm::dvec2(square.first) + 0.5 + double(square.edge) * glm::dvec2(k % 2, k / 2);
            rays[k] = picture.camera.ray(place.x, place.y);
            ends[k] = picture.end(rays[k]);
            open += !(ends[k] < picture.farAway);
        }
        mixed = open != 0 && open != 4;
        nearest = *std::ranges::min_element(ends);
        farthest = *std::ranges::max_element(ends);
    }
};

/// How the light of a lamp varies over a square.
Way wayOf(const Beam& beam, double share, const Corners& corners) {
    if (share < faintShare) return Way::plain;
    double miss = 1e300, before = 1e300;
    for (const Ray& ray : corners.rays) {
        const double along = glm::dot(beam.position() - ray.origin, ray.direction);
        miss = std::min(miss, glm::distance(beam.position(), ray.origin + std::max(0.0, along) * ray.direction));
        before = std::min(before, along);
    }
    const Ray &first = corners.rays[0], &last = corners.rays[3];
    const double diagonal = glm::length(last.origin - first.origin) + glm::distance(beam.position(), first.origin) *
                                                                          glm::length(last.direction - first.direction);
    const double bend = diagonal / std::max(miss, 1e-12);
    if (bend * bend < bent || (bend < 1.0 && share * bend * bend < bentShare)) return Way::plain;
    if (!(before > 0.0) || !(bend < nearest)) return Way::none;
    // the end cuts off light near the lamp
    if (corners.nearest < before + past * miss && corners.farthest > levelEnds * corners.nearest) return Way::none;
    return std::min(1.0, share) * poleBend * bend * bend * std::min(1.0, miss / before) < bentShare ? Way::pole
                                                                                                    : Way::none;
}

struct Smoother {
    const LitPicture& picture;
    const Haze& haze;
    bool solid;

    void add(const Square& square, std::span<const LampNode* const> groups, double done) const {
        const Corners corners(picture, square);
        const bool uneven = square.edge > block && corners.farthest > alikeEnds * corners.nearest;
        const bool mixed = solid || corners.mixed || uneven;
        if (mixed && square.edge > leastEdge) return addParts(square, groups, done);
        const double end = mixed ? picture.farAway : corners.farthest;
        const SeenLamps seen = lampsInFog(groups, haze, bundleOf(picture.camera, square, end), done);
        std::array<glm::dvec3, 4> plain{};
        std::vector<std::pair<const Beam*, std::array<glm::dvec3, 4>>> poles;
        std::vector<const LampNode*> left;
        for (const NodeLight& one : seen.nodes) {
            const Beam& beam = *one.node->beam;
            const Way way = mixed ? Way::none : wayOf(beam, seen.share(one), corners);
            if (way == Way::none) {
                left.push_back(one.node);
                continue;
            }
            done += luminanceOf(one.light);
            std::array<glm::dvec3, 4>& sum = way == Way::plain ? plain : poles.emplace_back(&beam, plain).second;
            for (std::size_t k = 0; k < 4; ++k) {
                const double miss = std::max(beam.radius(), missOf(corners.rays[k], beam.position()));
                const glm::dvec3 light = onceScattered(haze, beam, corners.rays[k], {0.0, corners.ends[k]}, miss);
                sum[k] = way == Way::plain ? sum[k] + light : light * miss;
            }
        }
        if (left.size() < seen.nodes.size()) interpolate(square, plain, poles);
        if (left.empty()) return;
        if (square.edge > leastEdge)
            addParts(square, left, done);
        else
            addNear(square, left);
    }

    void addParts(const Square& square, std::span<const LampNode* const> groups, double done) const {
        const int count = square.edge > block ? square.edge / block : 2, edge = square.edge / count;
        for (int i = 0; i < count * count; ++i)
            add({square.first + edge * glm::ivec2(i % count, i / count), edge}, groups, done);
    }

    template <class Poles>
    void interpolate(const Square& square, const std::array<glm::dvec3, 4>& plain, const Poles& poles) const {
        for (int i = 0; i < square.edge * square.edge; ++i) {
            const glm::ivec2 within(i % square.edge, i / square.edge);
            glm::dvec3* light = picture.light(square.first + within);
            if (light == nullptr) continue;
            const glm::dvec2 share = glm::dvec2(within) / double(square.edge);
            const auto between = [&](const std::array<glm::dvec3, 4>& at) {
                return glm::mix(glm::mix(at[0], at[1], share.x), glm::mix(at[2], at[3], share.x), share.y);
            };
            *light += between(plain);
            if (poles.empty()) continue;
            const glm::dvec2 place = glm::dvec2(square.first + within) + 0.5;
            const Ray ray = picture.camera.ray(place.x, place.y);
            for (const auto& [beam, at] : poles)
                *light += between(at) / std::max(beam->radius(), missOf(ray, beam->position()));
        }
    }

    void addNear(const Square& square, std::span<const LampNode* const> nodes) const {
        for (int i = 0; i < square.edge * square.edge; ++i) {
            const glm::ivec2 pixel = square.first + glm::ivec2(i % square.edge, i / square.edge);
            glm::dvec3* light = picture.light(pixel);
            if (light == nullptr) continue;
            for (const LampNode* node : nodes)
                *light += scatteredIn(picture, haze, *node->beam, glm::dvec2(pixel) + 0.5, pixel, 1.0);
        }
    }
};

}  // namespace

RayBundle bundleOf(const Camera& camera, const Square& square, double end) {
    const double edge = square.edge + 0.5;
    const auto rayOf = [&](const glm::dvec2& place) { return camera.ray(place.x, place.y); };
    RayBundle rays{rayOf(glm::dvec2(square.first) + 0.5 * edge), 0.0, 0.0, end};
    for (int k = 0; k < 4; ++k) {
        const Ray corner = rayOf(glm::dvec2(square.first) + edge * glm::dvec2(k % 2, k / 2));
        rays.width = std::max(rays.width, 1.1 * glm::distance(corner.origin, rays.middle.origin));
        rays.spread = std::max(rays.spread, 1.1 * glm::distance(corner.direction, rays.middle.direction));
    }
    return rays;
}

glm::dvec3 scatteredIn(const LitPicture& picture, const Haze& haze, const Beam& beam, const glm::dvec2& place,
                       const glm::ivec2& pixel, double edge) {
    const Ray ray = picture.camera.ray(place.x, place.y);
    return onceScattered(haze, beam, ray, {0.0, picture.endIn(pixel, ray)},
                         meanMiss(picture.camera, place, edge, ray, beam.position()));
}

void addSmoothLight(const LitPicture& picture, const Haze& haze, std::span<const LampNode* const> groups,
                    const Square& square, bool solid) {
    if (!groups.empty()) Smoother{picture, haze, solid}.add(square, groups, 0.0);
}

}  // namespace lumulus::lamp
