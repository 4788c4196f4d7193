#include "lamp/glow.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lamp/light_path.h"
#include "lamp/picture_plane.h"

namespace lumulus::lamp {

namespace {

/// Parts of the paths that threads share; each has sums of its own, which are added in their order.
constexpr std::size_t parts = 16;
/// Effective number of shares below which a coarser level is taken, and above which none of it is.
constexpr float few = 3.0F, many = 20.0F;
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

Glow::Glow(const Camera& camera, const Haze& haze, std::span<const Beam> beams,
           const std::optional<scene::Ground>& ground, const Paths& paths, const Check& check) {
    const PicturePlane plane(camera);
    cell_ = std::clamp(camera.height / 180, 1, 4);
    // what lies beside the picture serves at its rims
    if (camera.projection == scene::Projection::perspective) margin_ = cell_ * (camera.height / (4 * cell_));
    Level finest;
    finest.size = (glm::ivec2(camera.width, camera.height) + 2 * margin_ + cell_ - 1) / cell_;
    const std::size_t cells = static_cast<std::size_t>(finest.size.x) * static_cast<std::size_t>(finest.size.y);
    finest.light.assign(cells, glm::vec3(0.0F));
    finest.sum.assign(cells, 0.0F);
    finest.square.assign(cells, 0.0F);
    for (std::size_t i = 0; i < cells; ++i) {
        const glm::ivec2 cell(static_cast<int>(i) % finest.size.x, static_cast<int>(i) / finest.size.x);
        finest.solidAngle.push_back(
            static_cast<float>(plane.solidAngle(glm::dvec2(cell * cell_ - margin_), static_cast<double>(cell_))));
    }
    std::array<Level, parts> sums;
    const LightPaths light(haze, beams, ground, paths.count, paths.seed);
    tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
        Level& own = sums[part];
        own = finest;
        for (std::uint64_t i = part; i < paths.count; i += parts) {
            if (i / parts % 64 == 0) check();
            light.trace(i, camera.position, [&](const glm::dvec3& towards, const glm::dvec3& share) {
                const std::optional<glm::dvec2> place = plane.placeOf(towards, margin_);
                if (!place) return;
                const glm::ivec2 cell =
                    glm::min(glm::ivec2(*place + static_cast<double>(margin_)) / cell_, own.size - 1);
                const auto at = static_cast<std::size_t>(cell.y * own.size.x + cell.x);
                own.light[at] += glm::vec3(share);
                own.sum[at] += luminanceOf(share);
                own.square[at] += luminanceOf(share) * luminanceOf(share);
            });
        }
    });
    for (const Level& own : sums)
        for (std::size_t i = 0; i < cells; ++i) {
            finest.light[i] += own.light[i];
            finest.sum[i] += own.sum[i];
            finest.square[i] += own.square[i];
        }
    levels_.push_back(std::move(finest));
    addLevels();
}

void Glow::addLevels() {
    while (levels_.back().size != glm::ivec2(1)) {
        const Level& fine = levels_.back();
        Level coarse;
        coarse.size = (fine.size + 1) / 2;
        const std::size_t cells = static_cast<std::size_t>(coarse.size.x) * static_cast<std::size_t>(coarse.size.y);
        coarse.light.assign(cells, glm::vec3(0.0F));
        for (auto* values : {&coarse.sum, &coarse.square, &coarse.solidAngle}) values->assign(cells, 0.0F);
        for (int y = 0; y < fine.size.y; ++y)
            for (int x = 0; x < fine.size.x; ++x) {
                const auto from = static_cast<std::size_t>(y * fine.size.x + x);
                const auto to = static_cast<std::size_t>(y / 2 * coarse.size.x + x / 2);
                coarse.light[to] += fine.light[from];
                coarse.sum[to] += fine.sum[from];
                coarse.square[to] += fine.square[from];
                coarse.solidAngle[to] += fine.solidAngle[from];
            }
        levels_.push_back(std::move(coarse));
    }
}

glm::dvec3 Glow::at(const glm::dvec2& place) const {
    const auto placeIn = [&](std::size_t i) {
        return (place + static_cast<double>(margin_)) /
               (static_cast<double>(cell_) * std::pow(2.0, static_cast<double>(i)));
    };
    glm::vec3 result(0.0F);
    for (std::size_t i = levels_.size(); i-- > 0;) {
        const Level& level = levels_[i];
        // by a wide neighbourhood: cells that have missed their brightest shares would take themselves for sure
        const std::size_t wide = std::min(i + widerBy, levels_.size() - 1);
        const float shares = between<float>(levels_[wide].size, placeIn(wide),
                                            [&](std::size_t at) { return levels_[wide].effective(at); }) /
                             std::pow(4.0F, static_cast<float>(wide - i));
        const bool coarsest = i + 1 == levels_.size();
        const float weight = coarsest ? 1.0F : glm::smoothstep(few, many, shares);
        if (weight == 0.0F) continue;
        const glm::vec3 light = between<glm::vec3>(
            level.size, placeIn(i), [&](std::size_t at) { return level.light[at] / level.solidAngle[at]; });
        result = glm::mix(result, light, weight);
    }
    return glm::dvec3(result);
}

}  // namespace lumulus::lamp
