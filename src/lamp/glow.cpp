#include "lamp/glow.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace lumulus::lamp {

namespace {

/// Parts of the paths that threads share; each has sums of its own, which are added in their order.
constexpr std::size_t parts = 16;
/// Effective number of shares below which a coarser level is taken, and above which none of it is.
constexpr float few = 3.0F, many = 20.0F, fewInClouds = 30.0F, manyInClouds = 200.0F;
/// Least part of a cell that clouds are taken to cover.
constexpr double leastCover = 1e-3;
/// Rays across a cell by which that part is found.
constexpr int coverRays = 3;
/// Directions across the map of the clouds before the eye.
constexpr int eyeMapEdge = 256;
/// Levels by which a neighbourhood is coarser that tells how many shares a cell would have.
constexpr std::size_t widerBy = 3;

float luminanceOf(const glm::dvec3& rgb) {
    return static_cast<float>(glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)));
}

/// Bilinear interpolation between the middles of cells.
template <typename Value, typename ValueAt>
Value between(const glm::ivec2& size, const glm::dvec2& place, const ValueAt& valueAt) {
    const glm::dvec2 from = glm::floor(place - 0.5), share = place - 0.5 - from;
    Value sum(0.0F);
    for (int k = 0; k < 4; ++k) {
        const int right = k % 2, below = k / 2;
        const int x = std::clamp(static_cast<int>(from.x) + right, 0, size.x - 1);
        const int y = std::clamp(static_cast<int>(from.y) + below, 0, size.y - 1);
        const double weight = (right ? share.x : 1.0 - share.x) * (below ? share.y : 1.0 - share.y);
        sum += static_cast<float>(weight) * valueAt(static_cast<std::size_t>(y * size.x + x));
    }
    return sum;
}

}  // namespace

/// Cells of light from clouds, and from all else.
struct Glow::Kinds {
    Level open, clouds;
};

Glow::Level::Level(const glm::ivec2& cells) : size(cells) {
    const std::size_t count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    light.assign(count, glm::vec3(0.0F));
    for (auto* values : {&sum, &square, &solidAngle}) values->assign(count, 0.0F);
}

void Glow::Level::add(std::size_t i, const glm::dvec3& share) {
    const float luminance = luminanceOf(share);
    light[i] += glm::vec3(share);
    sum[i] += luminance;
    square[i] += luminance * luminance;
}

void Glow::Level::add(const Level& other) {
    for (std::size_t i = 0; i < light.size(); ++i) {
        light[i] += other.light[i];
        sum[i] += other.sum[i];
        square[i] += other.square[i];
    }
}

Glow::Glow(const Camera& camera, const Around& around, std::span<const Beam> beams, const Paths& paths,
           const Check& check) {
    const PicturePlane plane(camera);
    cell_ = std::clamp(camera.height / 180, 1, 4);
    // what lies beside the picture serves at its rims
    if (camera.projection == scene::Projection::perspective) margin_ = cell_ * (camera.height / (4 * cell_));
    const glm::ivec2 cells = (glm::ivec2(camera.width, camera.height) + 2 * margin_ + cell_ - 1) / cell_;
    const glm::ivec2 ofClouds = around.clouds.empty() ? glm::ivec2(0) : cells;
    Kinds all{Level(cells), Level(ofClouds)};
    const Cone inView = coneToClouds(around.clouds, camera.position, {camera.axes[2], std::numbers::pi});
    const DepthMap before(around.clouds, camera.position, inView, eyeMapEdge, check);
    DepthMap solids;
    if (around.solids != nullptr)
        solids = DepthMap(*around.solids, camera.position,
                          coneToSphere(around.solids->middle, around.solids->radius, camera.position,
                                       {camera.axes[2], std::numbers::pi}),
                          2 * eyeMapEdge, check);
    std::vector<Kinds> sums(parts, all);
    const LightPaths light(around, beams, paths.count, paths.seed);
    const Eye eye{camera.position, before, solids, light.leastDistance(camera.position)};
    tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
        Kinds& own = sums[part];
        for (std::uint64_t i = part; i < paths.count; i += parts) {
            if (i / parts % 64 == 0) check();
            light.trace(i, eye, [&](const glm::dvec3& towards, const glm::dvec3& share, bool inCloud) {
                const std::optional<glm::dvec2> place = plane.placeOf(towards, margin_);
                if (!place) return;
                const glm::ivec2 cell = glm::min(glm::ivec2(*place + static_cast<double>(margin_)) / cell_, cells - 1);
                (inCloud ? own.clouds : own.open).add(static_cast<std::size_t>(cell.y * cells.x + cell.x), share);
            });
        }
    });
    for (const Kinds& own : sums) {
        all.open.add(own.open);
        all.clouds.add(own.clouds);
    }
    findSolidAngles(camera, plane, around.clouds, check, all);
    levels_.push_back(std::move(all.open));
    addLevels(levels_);
    if (around.clouds.empty()) return;
    cloudLevels_.push_back(std::move(all.clouds));
    addLevels(cloudLevels_);
}

void Glow::findSolidAngles(const Camera& camera, const PicturePlane& plane, const Clouds& clouds, const Check& check,
                           Kinds& kinds) const {
    tbb::parallel_for(std::size_t{0}, kinds.open.solidAngle.size(), [&](std::size_t i) {
        const int across = kinds.open.size.x;
        const glm::dvec2 corner(glm::ivec2(static_cast<int>(i) % across, static_cast<int>(i) / across) * cell_ -
                                margin_);
        kinds.open.solidAngle[i] = static_cast<float>(plane.solidAngle(corner, static_cast<double>(cell_)));
        if (clouds.empty()) return;
        if (i % 256 == 0) check();
        double cover = 0.0;
        for (int k = 0; k < coverRays * coverRays; ++k) {
            const glm::dvec2 place =
                corner + (glm::dvec2(k % coverRays, k / coverRays) + 0.5) * (static_cast<double>(cell_) / coverRays);
            const double depth = clouds.depth(camera.ray(place.x, place.y), std::numeric_limits<double>::infinity());
            cover -= std::expm1(-depth) / (coverRays * coverRays);
        }
        kinds.clouds.solidAngle[i] = kinds.open.solidAngle[i] * static_cast<float>(std::max(leastCover, cover));
    });
}

void Glow::addLevels(Levels& levels) {
    while (levels.back().size != glm::ivec2(1)) {
        const Level& fine = levels.back();
        Level coarse((fine.size + 1) / 2);
        for (int y = 0; y < fine.size.y; ++y)
            for (int x = 0; x < fine.size.x; ++x) {
                const auto from = static_cast<std::size_t>(y * fine.size.x + x);
                const auto to = static_cast<std::size_t>(y / 2 * coarse.size.x + x / 2);
                coarse.light[to] += fine.light[from];
                coarse.sum[to] += fine.sum[from];
                coarse.square[to] += fine.square[from];
                coarse.solidAngle[to] += fine.solidAngle[from];
            }
        levels.push_back(std::move(coarse));
    }
}

glm::dvec3 Glow::at(const glm::dvec2& place, double cover) const {
    const glm::dvec3 open = mean(levels_, place, false);
    if (cloudLevels_.empty() || !(cover > 0.0)) return open;
    return open + cover * mean(cloudLevels_, place, true);
}

glm::dvec3 Glow::mean(const Levels& levels, const glm::dvec2& place, bool ofClouds) const {
    const float least = ofClouds ? fewInClouds : few, enough = ofClouds ? manyInClouds : many;
    const auto placeIn = [&](std::size_t i) {
        return (place + static_cast<double>(margin_)) /
               (static_cast<double>(cell_) * std::pow(2.0, static_cast<double>(i)));
    };
    glm::vec3 result(0.0F);
    for (std::size_t i = levels.size(); i-- > 0;) {
        const Level& level = levels[i];
        // by a wide neighbourhood: cells that have missed their brightest shares would take themselves for sure
        const std::size_t wide = std::min(i + widerBy, levels.size() - 1);
        const float shares = between<float>(levels[wide].size, placeIn(wide),
                                            [&](std::size_t at) { return levels[wide].effective(at); }) /
                             std::pow(4.0F, static_cast<float>(wide - i));
        const bool coarsest = i + 1 == levels.size();
        const float weight = coarsest ? 1.0F : glm::smoothstep(least, enough, shares);
        if (weight == 0.0F) continue;
        glm::vec3 light;
        if (ofClouds) {  // not of ratios: at the clouds' sides some have hardly anything to be divided by
            light = between<glm::vec3>(level.size, placeIn(i), [&](std::size_t at) { return level.light[at]; }) /
                    between<float>(level.size, placeIn(i), [&](std::size_t at) { return level.solidAngle[at]; });
        } else {
            light = between<glm::vec3>(level.size, placeIn(i),
                                       [&](std::size_t at) { return level.light[at] / level.solidAngle[at]; });
        }
        result = glm::mix(result, light, weight);
    }
    return glm::dvec3(result);
}

}  // namespace lumulus::lamp
