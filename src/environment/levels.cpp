#include "environment/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numbers>

#include "base/error.h"
#include "prefilter/cone.h"
#include "prefilter/prefilter.h"

namespace lumulus::environment {
namespace {

int sizesOf(int size) {
    return std::bit_width(static_cast<unsigned>(size));
}

std::vector<double> roughnessOf(Method method, int count, std::span<const double> given) {
    std::vector<double> result(given.begin(), given.end());
    if (!given.empty()) return result;
    if (method == Method::thesis)
        for (const prefilter::ConeLevel& level : prefilter::coneLevels) result.push_back(level.roughness);
    else
        for (int i = 0; i < count; ++i) result.push_back(i == 0 ? 0.0 : static_cast<double>(i) / (count - 1));
    return result;
}

/// Half the angle of the cone for a roughness that the thesis lists.
double coneAngle(double roughness) {
    const auto* found = std::ranges::find(prefilter::coneLevels, roughness, &prefilter::ConeLevel::roughness);
    return found->angle;
}

}  // namespace

std::vector<Level> levelsOf(Method method, int size, int count, std::span<const double> roughness) {
    const bool given = !roughness.empty();
    double before = -1.0;
    for (const double value : roughness) {
        if (!(value > before && value >= 0.0 && value <= 1.0))
            throw InputError(fmt::format("{:g} is no roughness behind {:g}", value, std::max(before, 0.0)),
                             "--roughness", "give rising numbers from 0 to 1");
        before = value;
    }
    const std::vector<double> all = roughnessOf(method, count, roughness);
    const auto sizes = static_cast<std::size_t>(sizesOf(size));
    if (all.empty() || all.size() > sizes)
        throw InputError(fmt::format("{} levels do not fit into faces of {} pixels", all.size(), size),
                         given ? "--roughness" : (method == Method::thesis ? "--size" : "--levels"),
                         fmt::format("give 1 to {}, or a larger --size", sizes));
    std::vector<Level> levels;
    for (std::size_t i = 0; i < all.size(); ++i) levels.push_back({all[i], size >> i});
    return levels;
}

int defaultLevels(int size) {
    constexpr int coarsest = 5;  // bits of 16
    return std::max(1, sizesOf(size) - coarsest + 1);
}

LevelFilter::LevelFilter(Method method, const prefilter::Panorama& panorama, int size, const Check& check)
    : method_(method), cube_(panorama, size, check), check_(check) {}

std::vector<glm::vec3> LevelFilter::filtered(const Level& level, std::span<const glm::vec3> directions) const {
    if (method_ == Method::thesis) return prefilter::coneMeans(cube_, coneAngle(level.roughness), directions, check_);
    const double texel = 4.0 * std::numbers::pi / (6.0 * level.size * level.size);
    const double alpha = level.roughness * level.roughness;
    return prefilter::filtered(cube_, prefilter::ggxLobe(alpha, cube_.size(), texel), directions, check_);
}

}  // namespace lumulus::environment
