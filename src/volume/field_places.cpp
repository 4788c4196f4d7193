#include "volume/field_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/interrupt.h"
#include "vdb/noise.h"
#include "volume/footprint.h"

namespace lumulus {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double tolerance = 0.005;  ///< of the cover
constexpr double closed = 0.995;     ///< cover of a closed deck: its last gaps are small

/// Mean of D² over the power law n(D) ∝ D^-exponent, and its quantiles.
struct PowerLaw {
    double smallest, largest, exponent;

    double integral(double power) const {
        const double p = power - exponent + 1.0;
        if (std::abs(p) < 1e-9) return std::log(largest / smallest);
        return (std::pow(largest, p) - std::pow(smallest, p)) / p;
    }
    double meanSquare() const { return largest > smallest ? integral(2.0) / integral(0.0) : smallest * smallest; }
    double quantile(double u) const {
        const double p = 1.0 - exponent;
        if (std::abs(p) < 1e-9) return smallest * std::pow(largest / smallest, u);
        return std::pow(glm::mix(std::pow(smallest, p), std::pow(largest, p), u), 1.0 / p);
    }
};

class Placer {
  public:
    Placer(const scene::Field& field, std::string name, std::size_t most)
        : field_(field), name_(std::move(name)), most_(most), extent_(field.area.x, field.area.z) {
        const std::string kind = proceduralKind(field.kind);
        // outlines of water clouds hardly depend on the voxels; fibres of ice are as wide as a voxel at least
        const int resolution = std::min(field.resolution, field.kind == scene::FieldKind::cirrus ? 128 : 48);
        for (int i = 0; i < field.variants; ++i) {
            footprints_.emplace_back(kind, variantSeed(field, i), resolution);
            diameters_.push_back(2.0 * std::sqrt(footprints_.back().area(threshold(1.0)) / pi));
            stopIfInterrupted();
        }
        constexpr double mostPoints = 4e6, pointsAcross = 8.0;
        const double typical = field.kind == scene::FieldKind::stratocumulus ? cellDiameter() : field.smallest;
        spacing_ = std::max(typical / pointsAcross, std::sqrt(extent_.x * extent_.y / mostPoints));
        const glm::dvec3 velocity = field.wind.at(field.base);
        const glm::dvec2 wind(velocity.x, velocity.z);
        along_ = glm::length(wind) > 0.0 ? glm::normalize(wind) : glm::dvec2(1.0, 0.0);
        windy_ = glm::length(wind) > 0.0;
    }

    std::vector<FieldPlace> scattered();
    std::vector<FieldPlace> deck();

  private:
    /// A cloud that is being placed: its middle lies relative to that of the area.
    struct Cloud {
        int variant = 0;
        glm::dvec2 middle{0.0};
        double diameter = 0.0;
        double angle = 0.0;  ///< radians from x towards z
    };
    struct Pass {
        std::vector<Cloud> clouds;
        double cover = 0.0;
    };

    double cellDiameter() const { return 0.5 * (field_.smallest + field_.largest); }
    /// The column [m of density 1 in the cloud's own size] from which a cloud is seen.
    double threshold(double scale) const {
        return field_.extinction > 0.0 ? visibleThickness / (field_.extinction * scale) : 0.0;
    }
    double scaleOf(const Cloud& cloud) const {
        return cloud.diameter / diameters_[static_cast<std::size_t>(cloud.variant)];
    }
    void checkCount(double count) const;
    float gathering(const glm::dvec2& place) const;
    double angleOf(vdb::RandomStream& random) const;
    void cover(CoverMap& map, const Cloud& cloud) const;
    Pass scatter(std::size_t count) const;
    glm::dvec2 bestPlace(const CoverMap& map, double diameter, vdb::RandomStream& random) const;
    Pass fillDeck(double gridSpacing) const;
    std::vector<Cloud> cellsOf(double gridSpacing) const;
    std::vector<FieldPlace> finished(const Pass& pass) const;

    const scene::Field& field_;
    std::string name_;
    std::size_t most_;
    glm::dvec2 extent_;
    std::vector<Footprint> footprints_;
    std::vector<double> diameters_;  ///< of circles with the areas of the footprints, metres
    double spacing_ = 1.0;           ///< of the points of the map, metres
    glm::dvec2 along_{1.0, 0.0};     ///< direction of the wind
    bool windy_ = false;
};

void Placer::checkCount(double count) const {
    if (count <= static_cast<double>(most_)) return;
    throw InputError(
        fmt::format("the field needs {:.0f} clouds, and photon_map.memory_budget has room for {}", count, most_), name_,
        "make the area or the cover smaller, or the smallest clouds larger");
}

/// Noise that is high where clouds gather: features of three large clouds, drawn out along the wind.
float Placer::gathering(const glm::dvec2& place) const {
    const double size = 3.0 * std::max(field_.largest, 1.0);
    const double length = windy_ ? 3.0 : 1.0;
    const glm::dvec2 p(glm::dot(place, along_) / length, along_.x * place.y - along_.y * place.x);
    return vdb::fractalNoise(glm::vec3(static_cast<float>(p.x / size), 0.5F, static_cast<float>(p.y / size)),
                             vdb::deriveSeed(field_.seed, 50), 3);
}

/// Fibres lie along the wind, other clouds anyhow.
double Placer::angleOf(vdb::RandomStream& random) const {
    const double u = static_cast<double>(random.uniform());
    if (field_.kind != scene::FieldKind::cirrus) return 2.0 * pi * u;
    constexpr double spread = 0.25;  // radians
    return std::atan2(along_.y, along_.x) + spread * (u - 0.5);
}

void Placer::cover(CoverMap& map, const Cloud& cloud) const {
    const double scale = scaleOf(cloud);
    map.add(footprints_[static_cast<std::size_t>(cloud.variant)], cloud.middle,
            {std::cos(cloud.angle), std::sin(cloud.angle)}, scale, threshold(scale));
}

/// The best of some random places: free of other clouds, with a rim around, and where clouds gather.
glm::dvec2 Placer::bestPlace(const CoverMap& map, double diameter, vdb::RandomStream& random) const {
    constexpr int candidates = 16, directions = 8;
    constexpr std::array<double, 3> rings{0.3, 0.55, 0.75};  // of the diameter
    constexpr double clustering = 0.35;
    glm::dvec2 best(0.0);
    double lowest = 1e9;
    for (int i = 0; i < candidates; ++i) {
        const double u = static_cast<double>(random.uniform()), v = static_cast<double>(random.uniform());
        const glm::dvec2 place = extent_ * (glm::dvec2(u, v) - 0.5);
        double taken = map.covered(place) ? 1.0 : 0.0;
        for (const double ring : rings) {
            for (int j = 0; j < directions; ++j) {
                const double angle = 2.0 * pi * j / directions;
                taken +=
                    map.covered(place + ring * diameter * glm::dvec2(std::cos(angle), std::sin(angle))) ? 1.0 : 0.0;
            }
        }
        const double score =
            taken / (1.0 + directions * rings.size()) - clustering * static_cast<double>(gathering(place));
        if (score >= lowest) continue;
        lowest = score;
        best = place;
    }
    return best;
}

/// Places `count` clouds, the large ones first.
Placer::Pass Placer::scatter(std::size_t count) const {
    stopIfInterrupted();
    const PowerLaw law{field_.smallest, field_.largest, field_.exponent};
    vdb::RandomStream random(vdb::deriveSeed(field_.seed, 51));
    CoverMap map(extent_, spacing_);
    Pass pass;
    for (std::size_t i = 0; i < count; ++i) {
        Cloud cloud;
        const double u =
            (static_cast<double>(count - 1 - i) + static_cast<double>(random.uniform())) / static_cast<double>(count);
        cloud.diameter = law.quantile(u);
        cloud.variant =
            std::min(static_cast<int>(random.uniform() * static_cast<float>(field_.variants)), field_.variants - 1);
        cloud.angle = angleOf(random);
        cloud.middle = bestPlace(map, cloud.diameter, random);
        cover(map, cloud);
        pass.clouds.push_back(cloud);
    }
    pass.cover = map.cover();
    return pass;
}

std::vector<FieldPlace> Placer::scattered() {
    const PowerLaw law{field_.smallest, field_.largest, field_.exponent};
    const double wanted = std::min(field_.cover, closed);
    const double each = 0.25 * pi * law.meanSquare() / (extent_.x * extent_.y);
    double low = 0.0, high = 0.0;  // counts of too few and too many clouds
    double count = std::max(1.0, std::round(wanted / each));
    Pass best;
    double error = 2.0;
    constexpr int passes = 14;
    for (int i = 0; i < passes && error > tolerance; ++i) {
        checkCount(count);
        Pass pass = scatter(static_cast<std::size_t>(count));
        const double found = pass.cover;
        if (std::abs(found - wanted) < error) {
            error = std::abs(found - wanted);
            best = std::move(pass);
        }
        (found < wanted ? low : high) = count;
        const double guess = found > 0.0 ? count * std::min(wanted / found, 2.0) : 2.0 * count;
        const bool between = guess > low && (high == 0.0 || guess < high);
        count = std::round(between ? guess : high > 0.0 ? 0.5 * (low + high) : 1.3 * low);
        if (count == low || count == high) break;
    }
    return finished(best);
}

/// Cells of a hexagonal grid whose middles lie in or just around the area, jittered. Those that gather come first.
std::vector<Placer::Cloud> Placer::cellsOf(double gridSpacing) const {
    vdb::RandomStream random(vdb::deriveSeed(field_.seed, 52));
    const double tilt = 2.0 * pi * static_cast<double>(random.uniform());
    const glm::dvec2 x(std::cos(tilt), std::sin(tilt)), y(-x.y, x.x);
    const glm::dvec2 half = 0.5 * extent_ + 0.45 * cellDiameter();
    const int rows = static_cast<int>(glm::length(half) / gridSpacing * 2.0 / std::sqrt(3.0)) + 2;
    const double across = 2.0 * rows + 1.0;
    checkCount(
        std::max(4.0 * half.x * half.y / (0.5 * std::sqrt(3.0) * gridSpacing * gridSpacing), across * across / 4.0));
    std::vector<Cloud> cells;
    std::vector<float> ranks;
    for (int row = -rows; row <= rows; ++row) {
        for (int column = -rows; column <= rows; ++column) {
            constexpr double jitter = 0.3;
            const glm::dvec2 shift(static_cast<double>(random.uniform(-0.5F, 0.5F)),
                                   static_cast<double>(random.uniform(-0.5F, 0.5F)));
            const glm::dvec2 at(column + 0.5 * (row & 1) + jitter * shift.x,
                                0.5 * std::sqrt(3.0) * row + jitter * shift.y);
            Cloud cell;
            cell.middle = gridSpacing * (at.x * x + at.y * y);
            cell.diameter = cellDiameter() * static_cast<double>(random.uniform(0.88F, 1.2F));
            cell.angle = angleOf(random);
            cell.variant =
                std::min(static_cast<int>(random.uniform() * static_cast<float>(field_.variants)), field_.variants - 1);
            const float rank = gathering(cell.middle) + 0.25F * random.uniform();
            if (std::abs(cell.middle.x) > half.x || std::abs(cell.middle.y) > half.y) continue;
            cells.push_back(cell);
            ranks.push_back(rank);
        }
    }
    std::vector<std::size_t> order(cells.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return ranks[a] > ranks[b]; });
    std::vector<Cloud> sorted;
    for (const std::size_t i : order) sorted.push_back(cells[i]);
    return sorted;
}

/// Adds cells until the wanted share is covered.
Placer::Pass Placer::fillDeck(double gridSpacing) const {
    stopIfInterrupted();
    CoverMap map(extent_, spacing_);
    Pass pass;
    for (const Cloud& cell : cellsOf(gridSpacing)) {
        if (pass.cover >= std::min(field_.cover, closed)) break;
        cover(map, cell);
        pass.cover = map.cover();
        pass.clouds.push_back(cell);
    }
    return pass;
}

std::vector<FieldPlace> Placer::deck() {
    const double wanted = std::min(field_.cover, closed);
    double gridSpacing = 0.8 * cellDiameter();
    Pass pass = fillDeck(gridSpacing);
    constexpr int passes = 10;
    for (int i = 0; i < passes && pass.cover < wanted; ++i) {
        gridSpacing *= 0.95;
        pass = fillDeck(gridSpacing);
    }
    return finished(pass);
}

std::vector<FieldPlace> Placer::finished(const Pass& pass) const {
    std::vector<FieldPlace> places;
    for (const Cloud& cloud : pass.clouds) {
        const glm::dvec3 position(field_.center.x + cloud.middle.x, field_.base, field_.center.z + cloud.middle.y);
        const double scale = scaleOf(cloud), top = scale * footprints_[static_cast<std::size_t>(cloud.variant)].top();
        places.push_back({cloud.variant, {position, cloud.angle * 180.0 / pi, scale, 1.0}, field_.base + 0.5 * top});
    }
    return places;
}

}  // namespace

std::string proceduralKind(scene::FieldKind kind) {
    switch (kind) {
        case scene::FieldKind::cumulus:
            return "cumulus";
        case scene::FieldKind::stratocumulus:
            return "stratocumulus";
        case scene::FieldKind::cirrus:
            return "cirrus";
    }
    return "";
}

std::uint64_t variantSeed(const scene::Field& field, int variant) {
    return vdb::deriveSeed(field.seed, 100U + static_cast<std::uint32_t>(variant));
}

std::vector<FieldPlace> placesOf(const scene::Field& field, const std::string& name, std::size_t most) {
    if (field.cover <= 0.0) return {};
    Placer placer(field, name, most);
    return field.kind == scene::FieldKind::stratocumulus ? placer.deck() : placer.scattered();
}

}  // namespace lumulus
