#include "light/photon/carried_light.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "light/photon/emission.h"
#include "light/photon/nearest_points.h"
#include "shared/collision_estimator.h"

namespace lumulus::photon {

namespace {

/// A collector is one of before where it is nearer than so much of the distance to the third nearest, squared.
constexpr double same = 1e-6;
/// Cells that had less of the mass that they have now have their light from collectors.
constexpr double fewestMass = 0.1;
/// Nearer to whole cells than this is rounding.
constexpr double wholeCell = 1e-6;
/// Y of band 0, and what makes a component of the mean direction of one of band 1.
constexpr double band0 = 0.28209479177387814, band1 = 0.57735026918962573;
constexpr double largest = 2305843009213693951.0;  // of the sums: accumulate.comp clamps them there

std::int64_t rounded(double value) {
    return std::llround(std::clamp(value, -largest, largest));
}

/// Collectors of before and the share of each; times their counts, these are light for each m².
struct Shares {
    int count = 0;
    std::array<std::size_t, NearestPoints::most> numbers{};
    std::array<double, NearestPoints::most> weights{};
};

/// Carries the light of one cloud.
class Carrier {
  public:
    Carrier(const CarriedPlan& fromPlan, const CarriedPlan& toPlan, const CarriedCloud& from, const CarriedCloud& to,
            std::span<const std::int64_t> counts, const Way& way, double factor, const Check& check)
        : fromPlan_(fromPlan),
          toPlan_(toPlan),
          counts_(counts),
          from_(from),
          to_(to),
          way_(way),
          factor_(factor),
          check_(check),
          toVoxels_{glm::inverse(from_.toCloud.linear), {}},
          nearest_(from_.places) {
        toVoxels_.translation = -(toVoxels_.linear * from_.toCloud.translation);
    }

    void carry(std::span<std::int64_t> result) const {
        const auto coefficients = static_cast<std::uint32_t>(3 * toPlan_.bands * toPlan_.bands);
        forAll(to_.places.size(), [&](std::size_t i) {
            const glm::dvec3& place = to_.places[i];
            const Shares shares = sharesAt(place - way_(place));
            const auto sumUp = [&](std::uint32_t from, std::uint32_t to, std::uint32_t each) {
                const std::uint64_t first = to + std::uint64_t{to_.firstCollector + i} * each;
                for (std::uint32_t k = 0; k < each; ++k)
                    result[first + k] = rounded(factor_ * to_.masses[i] * lightOf(shares, from, each, k));
            };
            sumUp(0, 0, coefficients);
            if (fromPlan_.axisCounts == toPlan_.axisCounts && toPlan_.axisCounts > 0)
                sumUp(fromPlan_.axisBase, toPlan_.axisBase, toPlan_.axisCounts);
        });
        if (from_.cells.edge > 0 && to_.cells.edge > 0) carryCells(result);
    }

  private:
    void forAll(std::size_t count, const auto& body) const {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
            check_();
            for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
        });
    }

    Shares sharesAt(const glm::dvec3& place) const {
        const NearestPoints::Found found = nearest_.near(place);
        const double third = found.squares[static_cast<std::size_t>(std::min(found.count, 3) - 1)];
        Shares shares;
        shares.numbers = found.numbers;
        shares.count = found.squares[0] <= same * third ? 1 : found.count;
        for (std::size_t k = 0; k < static_cast<std::size_t>(shares.count); ++k)
            shares.weights[k] = 1.0 / (found.squares[k] + (shares.count > 1 ? 0.25 * third : 1.0));
        if (shares.count > 1) balance(shares, place);
        double sum = 0.0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(shares.count); ++k)
            sum += shares.weights[k] * from_.masses[shares.numbers[k]];
        for (double& weight : shares.weights) weight /= sum;
        return shares;
    }

    /// Changes the weights so that the middle of the collectors lies nearer to the place: light that changes evenly in
    /// space stays as it is.
    void balance(Shares& shares, const glm::dvec3& place) const {
        constexpr double ridge = 0.1;  // of the mean spread, so that few collectors in a plane decide nothing across it
        glm::dvec3 first(0.0);
        glm::dmat3 second(0.0);
        for (std::size_t k = 0; k < static_cast<std::size_t>(shares.count); ++k) {
            const glm::dvec3 way = from_.places[shares.numbers[k]] - place;
            const double weight = shares.weights[k] * from_.masses[shares.numbers[k]];
            first += weight * way;
            second += weight * glm::outerProduct(way, way);
        }
        const double more = ridge / 3.0 * (second[0][0] + second[1][1] + second[2][2]);
        for (int axis = 0; axis < 3; ++axis) second[axis][axis] += more;
        const glm::dvec3 slope = -(glm::inverse(second) * first);
        if (!std::isfinite(slope.x + slope.y + slope.z)) return;
        std::array<double, NearestPoints::most> balanced{};
        double sum = 0.0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(shares.count); ++k) {
            const double change = 1.0 + glm::dot(slope, from_.places[shares.numbers[k]] - place);
            balanced[k] = shares.weights[k] * std::max(0.0, change);
            sum += balanced[k];
        }
        if (sum > 0.0) shares.weights = balanced;
    }

    /// Count `k` of `each` for a collector, for each m² there.
    double lightOf(const Shares& shares, std::uint32_t base, std::uint32_t each, std::uint32_t k) const {
        double light = 0.0;
        for (std::size_t s = 0; s < static_cast<std::size_t>(shares.count); ++s) {
            const std::uint64_t collector = from_.firstCollector + shares.numbers[s];
            light += shares.weights[s] * static_cast<double>(counts_[base + collector * each + k]);
        }
        return light;
    }

    /// Luminance of all directions that collectors have at a place, and its vector, for each m².
    glm::dvec4 collectorsAt(const glm::dvec3& place) const {
        const Shares shares = sharesAt(place);
        const auto each = static_cast<std::uint32_t>(fromPlan_.bands * fromPlan_.bands);
        const auto component = [&](std::uint32_t i) {
            glm::dvec3 rgb;
            for (std::uint32_t c = 0; c < 3; ++c) rgb[static_cast<int>(c)] = lightOf(shares, 0, 3 * each, c * each + i);
            return luminance(rgb);
        };
        glm::dvec4 light(glm::dvec3(0.0), component(0) / band0);
        if (fromPlan_.bands > 1) light += glm::dvec4(component(3), component(1), component(2), 0.0) * (band1 / band0);
        return light;
    }

    /// Where what is in the middle of a cube of `across` cells now was: in such cubes of before.
    glm::dvec3 placeBefore(const glm::ivec3& cube, int across, glm::dvec3& before) const {
        const double edge = to_.cells.edge * across;
        const glm::dvec3 now = to_.toCloud.point(edge * (glm::dvec3(cube) + 0.5));
        before = now - way_(now);
        glm::dvec3 place = toVoxels_.point(before) / static_cast<double>(from_.cells.edge * across) - 0.5;
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(place[axis] - std::round(place[axis])) < wholeCell) place[axis] = std::round(place[axis]);
        return place;
    }

    double massBefore(const glm::ivec3& cell) const {
        if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, from_.cells.cells)))
            return 0.0;
        return from_.cellMasses[massIndex(from_.cells.cells, cell)];
    }
    static std::size_t massIndex(const glm::ivec3& cells, const glm::ivec3& cell) {
        return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(cells.y) +
                static_cast<std::size_t>(cell.y)) *
                   static_cast<std::size_t>(cells.x) +
               static_cast<std::size_t>(cell.x);
    }
    /// Of the cells of a cube.
    static double massOfCube(const CarriedCloud& cloud, const glm::ivec3& cube) {
        double mass = 0.0;
        for (int i = 0; i < shared::CUBE_CELLS; ++i) {
            const glm::ivec3 cell = shared::FLUX_EDGE * cube + glm::ivec3(i & 1, (i >> 1) & 1, i >> 2);
            if (glm::all(glm::lessThan(cell, cloud.cells.cells)))
                mass += cloud.cellMasses[massIndex(cloud.cells.cells, cell)];
        }
        return mass;
    }

    /// Calls `add` with the 64 neighbours of a place and their weights of a cubic (Catmull-Rom).
    static void interpolateCubic(const glm::dvec3& place, const auto& add) {
        const glm::dvec3 low = glm::floor(place), t = place - low;
        std::array<glm::dvec3, 4> w;
        w[0] = 0.5 * t * (t * (2.0 - t) - 1.0);
        w[1] = 0.5 * (t * t * (3.0 * t - 5.0) + 2.0);
        w[2] = 0.5 * t * (t * (4.0 - 3.0 * t) + 1.0);
        w[3] = 0.5 * t * t * (t - 1.0);
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    const double weight = w[static_cast<std::size_t>(i)].x * w[static_cast<std::size_t>(j)].y *
                                          w[static_cast<std::size_t>(k)].z;
                    if (weight != 0.0) add(glm::ivec3(low) + glm::ivec3(i, j, k) - 1, weight);
                }
    }

    /// Calls `add` with the eight neighbours of a place and their weights, as far as these are above 0.
    static void interpolate(const glm::dvec3& place, const auto& add) {
        const glm::dvec3 low = glm::floor(place), share = place - low;
        for (int i = 0; i < 8; ++i) {
            const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
            const glm::dvec3 each = glm::mix(1.0 - share, share, glm::dvec3(corner));
            const double weight = each.x * each.y * each.z;
            if (weight > 0.0) add(glm::ivec3(low) + corner, weight);
        }
    }

    std::int64_t countAt(const glm::ivec3& cell, std::uint32_t more) const {
        return counts_[from_.estimatorBase + shared::cubePlace(from_.cells.cells, cell) + more];
    }

    void carryCells(std::span<std::int64_t> result) const {
        const glm::ivec3 cells = to_.cells.cells, cubes = (cells + shared::FLUX_EDGE - 1) / shared::FLUX_EDGE;
        const auto all =
            static_cast<std::size_t>(cubes.x) * static_cast<std::size_t>(cubes.y) * static_cast<std::size_t>(cubes.z);
        forAll(all, [&](std::size_t number) {
            const auto n = static_cast<int>(number);
            const glm::ivec3 cube(n % cubes.x, n / cubes.x % cubes.y, n / (cubes.x * cubes.y));
            if (massOfCube(to_, cube) <= 0.0) return;
            carryFlux(cube, result);
            for (int i = 0; i < shared::CUBE_CELLS; ++i) {
                const glm::ivec3 cell = shared::FLUX_EDGE * cube + glm::ivec3(i & 1, (i >> 1) & 1, i >> 2);
                if (glm::all(glm::lessThan(cell, cells))) carryAmount(cell, result);
            }
        });
    }

    /// By a cubic, as cells forget their surroundings from frame to frame where they are interpolated linearly; within
    /// what is there.
    void carryAmount(const glm::ivec3& cell, std::span<std::int64_t> result) const {
        const double now = to_.cellMasses[massIndex(to_.cells.cells, cell)];
        if (now <= 0.0) return;
        glm::dvec3 before;
        const glm::dvec3 place = placeBefore(cell, 1, before);
        double mass = 0.0, amount = 0.0, cubicMass = 0.0, cubicAmount = 0.0;
        double least = std::numeric_limits<double>::infinity(), most = -least;
        interpolate(place, [&](const glm::ivec3& at, double weight) {
            const double here = massBefore(at);
            if (here <= 0.0) return;
            const auto count = static_cast<double>(countAt(at, shared::placeInCube(at)));
            mass += weight * here;
            amount += weight * count;
            least = std::min(least, count / here);
            most = std::max(most, count / here);
        });
        interpolateCubic(place, [&](const glm::ivec3& at, double weight) {
            const double here = massBefore(at);
            if (here <= 0.0) return;
            cubicMass += weight * here;
            cubicAmount += weight * static_cast<double>(countAt(at, shared::placeInCube(at)));
        });
        double light = 0.0;
        if (mass < fewestMass * now)
            light = collectorsAt(before).w;
        else
            light = cubicMass > 0.5 * mass ? std::clamp(cubicAmount / cubicMass, least, most) : amount / mass;
        result[to_.estimatorBase + shared::cubePlace(to_.cells.cells, cell) + shared::placeInCube(cell)] =
            rounded(factor_ * now * light);
    }

    void carryFlux(const glm::ivec3& cube, std::span<std::int64_t> result) const {
        const double now = massOfCube(to_, cube);
        const glm::ivec3 cubesBefore = (from_.cells.cells + shared::FLUX_EDGE - 1) / shared::FLUX_EDGE;
        glm::dvec3 before, flux(0.0);
        double mass = 0.0;
        interpolate(placeBefore(cube, shared::FLUX_EDGE, before), [&](const glm::ivec3& at, double weight) {
            if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, cubesBefore))) return;
            mass += weight * massOfCube(from_, at);
            for (int axis = 0; axis < 3; ++axis)
                flux[axis] +=
                    weight * static_cast<double>(countAt(shared::FLUX_EDGE * at,
                                                         static_cast<std::uint32_t>(shared::CUBE_CELLS + axis)));
        });
        const glm::dvec3 light = mass >= fewestMass * now ? flux / mass : glm::dvec3(collectorsAt(before));
        const std::uint32_t first = to_.estimatorBase + shared::cubePlace(to_.cells.cells, shared::FLUX_EDGE * cube) +
                                    static_cast<std::uint32_t>(shared::CUBE_CELLS);
        for (int axis = 0; axis < 3; ++axis)
            result[first + static_cast<std::uint32_t>(axis)] = rounded(factor_ * now * light[axis]);
    }

    const CarriedPlan &fromPlan_, &toPlan_;
    std::span<const std::int64_t> counts_;
    const CarriedCloud &from_, &to_;
    const Way& way_;
    double factor_;
    const Check& check_;
    vdb::Affine toVoxels_;  ///< of before
    NearestPoints nearest_;
};

/// What a cloud was; null where nothing was kept of it.
const CarriedCloud* cloudBefore(const CarriedPlan& from, const CarriedCloud& cloud) {
    const auto found = std::ranges::find(from.clouds, cloud.number, &CarriedCloud::number);
    return found != from.clouds.end() && !found->places.empty() ? &*found : nullptr;
}

}  // namespace

bool hasLightFor(const CarriedPlan& from, const CarriedPlan& to) {
    const bool all = std::ranges::all_of(to.clouds, [&](const CarriedCloud& cloud) {
        return cloud.places.empty() || cloudBefore(from, cloud) != nullptr;
    });
    return all && from.bands == to.bands && from.generations > 0.0;
}

std::vector<std::int64_t> carriedCounts(const CarriedPlan& from, std::span<const std::int64_t> counts,
                                        const CarriedPlan& to, std::span<const Way> ways, double generations,
                                        double factor, const Check& check) {
    std::vector<std::int64_t> result(to.counts);
    const double each = factor * generations / from.generations;
    for (std::size_t i = 0; i < to.clouds.size(); ++i)
        if (!to.clouds[i].places.empty())
            Carrier(from, to, *cloudBefore(from, to.clouds[i]), to.clouds[i], counts, ways[i], each, check)
                .carry(result);
    if (from.counts - from.groundBase == to.counts - to.groundBase)
        for (std::uint32_t i = 0; i < to.counts - to.groundBase; ++i)
            result[to.groundBase + i] = rounded(each * static_cast<double>(counts[from.groundBase + i]));
    return result;
}

}  // namespace lumulus::photon
