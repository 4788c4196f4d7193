#include "light/fog_change/change_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "shared/sh.h"

namespace lumulus::fog_change {

namespace {

/// Parts of the cells that are added to at a time.
constexpr int parts = 8;
/// Share of a level's square in whose border it fades into the next.
constexpr double border = 0.2;

}  // namespace

std::array<float, coefficientCount> harmonicsOf(const glm::vec3& direction) {
    float all[shared::shMaxCoefficients];
    shared::shEvaluate(bandCount, direction, all);
    std::array<float, coefficientCount> made{};
    std::copy_n(all, coefficientCount, made.begin());
    return made;
}

ChangeCells::ChangeCells(const glm::dvec2& middle, double halfWidth, std::vector<double> heights)
    : middle_(middle), halfWidth_(halfWidth), heights_(std::move(heights)) {
    for (std::size_t i = 0; i + 1 < heights_.size(); ++i) middles_.push_back(0.5 * (heights_[i] + heights_[i + 1]));
    light_.resize(static_cast<std::size_t>(levels) * layers() * across * across * Sums().size());
}

double ChangeCells::halfWidth(int level) const {
    return std::ldexp(halfWidth_, level);
}

std::size_t ChangeCells::layerOf(double height) const {
    const auto next = std::upper_bound(heights_.begin() + 1, heights_.end() - 1, height);
    return static_cast<std::size_t>(next - heights_.begin()) - 1;
}

int ChangeCells::number(int level, const glm::ivec3& cell) const {
    return ((level * static_cast<int>(layers()) + cell.y) * across + cell.z) * across + cell.x;
}

int ChangeCells::cellAt(int level, const glm::dvec3& point) const {
    const glm::dvec2 place = (glm::dvec2(point.x, point.z) - middle_ + halfWidth(level)) / edge(level);
    const glm::ivec2 cell = glm::clamp(glm::ivec2(glm::floor(place)), glm::ivec2(0), glm::ivec2(across - 1));
    return number(level, {cell.x, static_cast<int>(layerOf(point.y)), cell.y});
}

double ChangeCells::volume(int cell) const {
    const int layer = cell / (across * across);
    const double width = edge(layer / static_cast<int>(layers()));
    const auto y = static_cast<std::size_t>(layer) % layers();
    return width * width * (heights_[y + 1] - heights_[y]);
}

void ChangeCells::add(std::span<const Passing> passing) {
    tbb::parallel_for(0, parts, [&](int part) {
        for (const Passing& one : passing) {
            if (one.cell % parts != part) continue;
            float* to = valuesOf(one.cell);
            if (one.isBeam) {
                to += beamPlace;
                for (int c = 0; c < 3; ++c, ++to) {
                    to[0] += one.light[c];
                    to[3] += one.straight[c];
                }
                continue;
            }
            for (const float harmonic : harmonicsOf(one.direction))
                for (int c = 0; c < 3; ++c) *to++ += harmonic * one.light[c];
        }
    });
}

void ChangeCells::finish(double scale) {
    for (float& value : light_) value *= static_cast<float>(scale);
    constexpr int quarter = across / 4;
    for (int level = 1; level < levels; ++level)
        for (int y = 0; y < static_cast<int>(layers()); ++y)
            for (int z = 0; z < across / 2; ++z)
                for (int x = 0; x < across / 2; ++x) {
                    float* to = valuesOf(number(level, {quarter + x, y, quarter + z}));
                    std::fill_n(to, Sums().size(), 0.0F);
                    for (int i = 0; i < 4; ++i) {
                        const float* from = valuesOf(number(level - 1, {2 * x + i % 2, y, 2 * z + i / 2}));
                        for (std::size_t k = 0; k < Sums().size(); ++k) to[k] += 0.25F * from[k];
                    }
                }
}

void ChangeCells::addLevel(Sums& sums, int level, const glm::dvec3& point, float weight) const {
    const glm::dvec2 place = (glm::dvec2(point.x, point.z) - middle_ + halfWidth(level)) / edge(level) - 0.5;
    const glm::dvec2 within = glm::clamp(place, glm::dvec2(0.0), glm::dvec2(across - 1.0));
    const glm::ivec2 first = glm::min(glm::ivec2(within), glm::ivec2(across - 2));
    const glm::vec2 f = glm::vec2(within - glm::dvec2(first));
    const auto next = std::upper_bound(middles_.begin() + 1, middles_.end() - 1, point.y);
    const auto layer = static_cast<std::size_t>(next - middles_.begin()) - 1;
    const auto up =
        static_cast<float>(std::clamp((point.y - middles_[layer]) / (middles_[layer + 1] - middles_[layer]), 0.0, 1.0));
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = (corner >> 1) & 1, z = corner >> 2;
        const float share =
            weight * (x == 1 ? f.x : 1.0F - f.x) * (y == 1 ? up : 1.0F - up) * (z == 1 ? f.y : 1.0F - f.y);
        if (share == 0.0F) continue;
        const int cell = number(level, {first.x + x, static_cast<int>(layer) + y, first.y + z});
        const float* from = light_.data() + static_cast<std::size_t>(cell) * sums.size();
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += share * from[k];
    }
}

Travelling ChangeCells::at(const glm::dvec3& point, const std::array<float, coefficientCount>& harmonics) const {
    Travelling made;
    const double away = std::max(std::abs(point.x - middle_.x), std::abs(point.z - middle_.y));
    if (away >= halfWidth(levels - 1) || point.y < bottom() || point.y > top()) return made;
    int level = 0;
    while (away >= halfWidth(level)) ++level;
    const double fade = std::clamp((1.0 - away / halfWidth(level)) / border, 0.0, 1.0);
    Sums sums{};
    addLevel(sums, level, point, static_cast<float>(fade));
    if (fade < 1.0 && level + 1 < levels) addLevel(sums, level + 1, point, static_cast<float>(1.0 - fade));
    std::size_t i = 0;
    for (std::size_t l = 0; l < made.bands.size(); ++l)
        for (std::size_t m = 0; m < 2 * l + 1; ++m, ++i)
            made.bands[l] += harmonics[i] * glm::vec3(sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]);
    made.beam = {sums[beamPlace], sums[beamPlace + 1], sums[beamPlace + 2]};
    made.straight = {sums[beamPlace + 3], sums[beamPlace + 4], sums[beamPlace + 5]};
    return made;
}

}  // namespace lumulus::fog_change
