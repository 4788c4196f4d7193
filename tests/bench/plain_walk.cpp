#include "bench/plain_walk.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "light/photon/emission.h"
#include "shared/phase.h"
#include "shared/phase_table.h"
#include "shared/photon.h"
#include "shared/sh.h"

namespace lumulus::bench {

namespace {

constexpr int coefficients = PlainWalk::bands * PlainWalk::bands;
constexpr std::uint16_t noCollector = 0xFFFF;

std::size_t at(const glm::ivec3& i, const glm::ivec3& size) {
    return (static_cast<std::size_t>(i.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(i.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i.x);
}

float largest(const glm::vec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

}  // namespace

/// xoshiro128+ (Blackman and Vigna 2021): for each task its own.
class PlainWalk::Random {
  public:
    explicit Random(std::uint64_t seed) {
        for (std::uint32_t& word : state_) {  // splitmix64
            std::uint64_t z = (seed += 0x9E3779B97F4A7C15ULL);
            z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
            z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
            word = static_cast<std::uint32_t>(z >> 32U);
        }
    }
    /// In [0,1).
    float operator()() {
        const std::uint32_t result = state_[0] + state_[3];
        const std::uint32_t t = state_[1] << 9U;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= t;
        state_[3] = std::rotl(state_[3], 11);
        return static_cast<float>(result >> 8U) * 0x1p-24F;
    }

  private:
    std::uint32_t state_[4];
};

struct PlainWalk::Lights {
    glm::vec3 travel;  // of the sun's light
    float cone;        // 1 − cos of the disc's radius
    glm::vec3 sunPower, skyPower;
    glm::mat3 faceArea;
};

struct PlainWalk::Photon {
    glm::ivec3 cell;
    glm::vec3 offset;  // in the cell, 0…1
    glm::vec3 direction;
    glm::vec3 power;
    bool ofSun;
    int turns = 0;
};

template <class Number>
struct PlainWalk::Sums {
    explicit Sums(std::size_t collectors) : values(collectors * 3 * coefficients, Number{0}) {}
    std::vector<Number> values;
    std::uint64_t events = 0, nulls = 0, records = 0;
};

PlainWalk::PlainWalk(const vdb::Volume& volume, const cloud::Asset& cloud, const photon::Medium& medium)
    : medium_(medium),
      collectors_(cloud.collectors.size()),
      size_(cloud.size),
      cells_(cloud.majorants.cells),
      cellSize_(cloud.majorants.cellSize),
      worldToCells_(glm::mat3(glm::inverse(cloud.voxelToMetres))),
      faceArea_(photon::faceAreas(cloud.voxelToMetres, glm::dvec3(cloud.size))),
      majorants_(cloud::majorantsAndDistances(cloud.majorants)),
      density_(volume.density.size()),
      collectorIndex_(volume.density.size(), noCollector) {
    for (int axis = 0; axis < 3; ++axis) worldToCells_[axis] /= cellSize_;
    const double f = static_cast<double>(medium.tables.forwardFraction);
    const double least = std::min({medium.albedo.x, medium.albedo.y, medium.albedo.z});
    extinction_ = static_cast<float>(medium.extinction * (1.0 - f * least));
    scatterShare_ = static_cast<float>((1.0 - f) / (1.0 - f * least));
    straightWeight_ = least < 1.0 ? glm::vec3((medium.albedo - least) / (1.0 - least)) : glm::vec3(0.0F);
    for (std::size_t i = 0; i < density_.size(); ++i)
        density_[i] = static_cast<std::uint16_t>(std::lround(65535.0F * volume.density[i] / volume.maximum));
    for (std::size_t i = 0; i < collectors_; ++i) {
        const shared::LeafBox& box = cloud.collectors[i].box;
        for (int z = box.lower.z; z < box.upper.z; ++z)
            for (int y = box.lower.y; y < box.upper.y; ++y)
                std::fill_n(collectorIndex_.begin() + static_cast<std::ptrdiff_t>(at({box.lower.x, y, z}, size_)),
                            box.upper.x - box.lower.x, static_cast<std::uint16_t>(i));
    }
}

/// One of the eight voxels around the place, by the weights of trilinear interpolation. The outermost voxels are zero,
/// so that positions beyond their centres can be moved there.
float PlainWalk::densityNear(const glm::vec3& voxel, Random& random) const {
    const glm::vec3 place = voxel + (glm::vec3(random(), random(), random()) + 0.5F);  // one up, as casts cut
    const glm::ivec3 near = glm::clamp(glm::ivec3(place) - 1, glm::ivec3(0), size_ - 1);
    return static_cast<float>(density_[at(near, size_)]) * (1.0F / 65535.0F);
}

PlainWalk::Photon PlainWalk::emit(const Lights& lights, bool ofSun, Random& random) const {
    const float twoPi = 2.0F * std::numbers::pi_v<float>;
    Photon photon;
    photon.ofSun = ofSun;
    glm::vec3 weights;
    if (ofSun) {
        photon.direction = shared::rotateDirection(lights.travel, shared::angleFromOneMinusCos(lights.cone * random()),
                                                   twoPi * random());
        weights = glm::abs(photon.direction * lights.faceArea);
        const glm::vec3 middle = glm::abs(lights.travel * lights.faceArea);
        photon.power = lights.sunPower * ((weights.x + weights.y + weights.z) / (middle.x + middle.y + middle.z));
    } else {
        weights = {glm::length(lights.faceArea[0]), glm::length(lights.faceArea[1]), glm::length(lights.faceArea[2])};
        photon.power = lights.skyPower;
    }
    const float pick = random() * (weights.x + weights.y + weights.z);
    const int axis = pick < weights.x ? 0 : (pick < weights.x + weights.y ? 1 : 2);
    bool upper = random() < 0.5F;
    if (ofSun) {
        upper = glm::dot(lights.faceArea[axis], photon.direction) < 0.0F;
    } else {
        const glm::vec3 inwards = (upper ? -1.0F : 1.0F) * lights.faceArea[axis] / weights[axis];
        const float u = random(), cosine = std::sqrt(1.0F - u);
        photon.direction = shared::rotateDirection(
            inwards, shared::ScatterAngle{u / (1.0F + cosine), 1.0F + cosine, std::sqrt(u)}, twoPi * random());
    }
    glm::vec3 point;
    point[axis] = upper ? static_cast<float>(size_[axis]) : 0.0F;
    point[(axis + 1) % 3] = random() * static_cast<float>(size_[(axis + 1) % 3]);
    point[(axis + 2) % 3] = random() * static_cast<float>(size_[(axis + 2) % 3]);
    photon.cell = glm::clamp(glm::ivec3(point / cellSize_), glm::ivec3(0), cells_ - 1);
    photon.offset = glm::clamp(point / cellSize_ - glm::vec3(photon.cell), 0.0F, 1.0F);
    return photon;
}

template <class Number>
void PlainWalk::record(const Photon& photon, const glm::vec3& voxel, Sums<Number>& sums) const {
    const glm::ivec3 place = glm::min(glm::ivec3(voxel), size_ - 1);
    const std::uint16_t collector = collectorIndex_[at(place, size_)];
    if (collector == noCollector) return;
    float y[shared::shMaxCoefficients];
    shared::shEvaluate(bands, photon.direction, y);
    Number* sum = sums.values.data() + static_cast<std::size_t>(collector) * 3 * coefficients;
    for (int channel = 0; channel < 3; ++channel)
        for (int i = 0; i < coefficients; ++i) {
            const float part = photon.power[channel] * y[i];
            if constexpr (std::is_integral_v<Number>)
                sum[channel * coefficients + i] += static_cast<std::int32_t>(std::nearbyint(part));
            else
                sum[channel * coefficients + i] += part;
        }
    ++sums.records;
}

/// False: absorbed. Russian roulette keeps the largest channel where it was.
template <class Number>
bool PlainWalk::collide(Photon& photon, const glm::vec3& voxel, Random& random, Sums<Number>& sums) const {
    const auto survives = [&](const glm::vec3& factor) {
        const float before = largest(photon.power);
        photon.power *= factor;
        const float after = largest(photon.power);
        if (!(random() * before < after)) return false;
        photon.power *= before / after;
        return true;
    };
    if (scatterShare_ < 1.0F && random() >= scatterShare_) return survives(straightWeight_);
    if (photon.turns > 0 || !photon.ofSun) record(photon, voxel, sums);
    ++photon.turns;
    const glm::vec3 albedo(medium_.albedo);
    if (albedo != glm::vec3(1.0F) && !survives(albedo)) return false;
    const phase::ScatteringTables& tables = medium_.tables;
    shared::ScatterAngle angle{};
    if (tables.analyticHg) {
        angle = shared::sampleHg(tables.g, random(), tables.scatterFraction);
    } else {
        const shared::TableCell cell = shared::inverseCdfCell(random());
        const float* entry = tables.inverseCdf.values().data() + cell.base;
        angle = shared::angleFromOneMinusCos(entry[0] + cell.fraction * (entry[1] - entry[0]));
    }
    photon.direction = shared::rotateDirection(photon.direction, angle, 2.0F * std::numbers::pi_v<float> * random());
    return true;
}

template <class Number>
void PlainWalk::walk(Photon& photon, Random& random, Sums<Number>& sums) const {
    glm::vec3 velocity = worldToCells_ * photon.direction, slowness = 1.0F / velocity;
    float depth = -std::log(1.0F - random());
    while (true) {
        const float entry = majorants_[at(photon.cell, cells_)];
        const float majorant = std::max(entry, 0.0F);
        const float reach = entry < 0.0F ? -entry - 1.0F : 0.0F;  // empty cells around this one
        float nearest = 3.4e38F;
        int axis = 0;
        for (int i = 0; i < 3; ++i) {
            if (velocity[i] == 0.0F) continue;
            const float face = velocity[i] > 0.0F ? 1.0F + reach : -reach;
            const float distance = (face - photon.offset[i]) * slowness[i];
            if (distance < nearest) nearest = distance, axis = i;
        }
        nearest = std::max(nearest, 0.0F);
        const float crossing = majorant * extinction_ * nearest;
        if (depth < crossing) {
            photon.offset = glm::clamp(photon.offset + velocity * (depth / (majorant * extinction_)), 0.0F, 1.0F);
            depth = -std::log(1.0F - random());
            const glm::vec3 voxel = (glm::vec3(photon.cell) + photon.offset) * cellSize_;
            if (random() * majorant >= densityNear(voxel, random)) {
                ++sums.nulls;
                continue;
            }
            ++sums.events;
            if (!collide(photon, voxel, random, sums)) return;
            velocity = worldToCells_ * photon.direction;
            slowness = 1.0F / velocity;
            continue;
        }
        depth -= crossing;
        const glm::vec3 end = photon.offset + velocity * nearest;
        glm::vec3 passed = glm::clamp(glm::floor(end), -reach, reach);
        passed[axis] = velocity[axis] > 0.0F ? 1.0F + reach : -1.0F - reach;
        photon.offset = glm::clamp(end - passed, 0.0F, 1.0F);
        photon.cell += glm::ivec3(passed);
        if (glm::any(glm::lessThan(photon.cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(photon.cell, cells_)))
            return;
    }
}

template <class Number>
WalkResult<Number> PlainWalk::trace(const scene::Sun& sun, const scene::Sky& sky, std::uint64_t photons,
                                    std::uint64_t seed) const {
    constexpr std::uint64_t task = 256;
    const photon::Emission emission = photon::makeEmission(sun, sky, faceArea_);
    const std::uint64_t ofSun = emission.sunPhotons(photons, 0.5);
    const double radius = glm::radians(0.25 * sun.angularDiameter);
    WalkResult<Number> result;
    if constexpr (std::is_integral_v<Number>) {
        const float most = largest(glm::max(emission.sunPower(photons), emission.skyPower(photons)));
        result.unit = static_cast<double>(most / (shared::POWER_UNITS * shared::COEFFICIENT_SCALE));
    }
    const Lights lights{glm::vec3(-sun.directionTo), static_cast<float>(2.0 * std::pow(std::sin(radius), 2)),
                        glm::vec3(emission.sunPower(photons) / result.unit),
                        glm::vec3(emission.skyPower(photons) / result.unit), glm::mat3(faceArea_)};
    tbb::enumerable_thread_specific<Sums<Number>> perThread(collectors_);
    tbb::parallel_for(std::uint64_t{0}, (photons + task - 1) / task, [&](std::uint64_t block) {
        Random random(seed * 0x1000000ULL + block);
        Sums<Number>& sums = perThread.local();
        for (std::uint64_t i = block * task; i < std::min((block + 1) * task, photons); ++i) {
            Photon photon = emit(lights, i < ofSun, random);
            walk(photon, random, sums);
        }
    });
    result.sums.assign(collectors_ * 3 * coefficients, Number{0});
    for (const Sums<Number>& sums : perThread) {
        for (std::size_t i = 0; i < result.sums.size(); ++i) result.sums[i] += sums.values[i];
        result.events += sums.events;
        result.nulls += sums.nulls;
        result.records += sums.records;
    }
    return result;
}

template WalkResult<float> PlainWalk::trace(const scene::Sun&, const scene::Sky&, std::uint64_t, std::uint64_t) const;
template WalkResult<std::int64_t> PlainWalk::trace(const scene::Sun&, const scene::Sky&, std::uint64_t,
                                                   std::uint64_t) const;

}  // namespace lumulus::bench
