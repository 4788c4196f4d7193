#include "light/light_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gpu/transfer.h"
#include "shared/collision_estimator.h"
#include "shared/photon.h"
#include "support/cloud_cases.h"
#include "support/vulkan_fixture.h"

namespace lumulus::light {
namespace {

using glm::dvec4;
using glm::ivec3;

/// Values at voxels or cells, 0 outside.
template <class Value>
struct Grid {
    ivec3 size;
    std::vector<Value> values;

    explicit Grid(const ivec3& extent)
        : size(extent), values(static_cast<std::size_t>(extent.x * extent.y * extent.z)) {}
    std::size_t index(const ivec3& at) const {
        return static_cast<std::size_t>((at.z * size.y + at.y) * size.x + at.x);
    }
    Value operator()(const ivec3& at) const {
        const bool inside = glm::all(glm::greaterThanEqual(at, ivec3(0))) && glm::all(glm::lessThan(at, size));
        return inside ? values[index(at)] : Value(0);
    }
    /// The sum with weights (side, 1 − 2 side, side) along each axis.
    Value smoothed(const ivec3& at, double side) const {
        Value sum(0);
        for (int k = 0; k < 27; ++k) {
            const ivec3 away(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            double weight = 1.0;
            for (int axis = 0; axis < 3; ++axis) weight *= away[axis] == 0 ? 1.0 - 2.0 * side : side;
            sum += weight * (*this)(at + away);
        }
        return sum;
    }
};

template <class Do>
void forEach(const ivec3& lower, const ivec3& upper, const Do& act) {
    for (int z = lower.z; z < upper.z; ++z)
        for (int y = lower.y; y < upper.y; ++y)
            for (int x = lower.x; x < upper.x; ++x) act(ivec3(x, y, z));
}

// Light that is the same in all collectors, and counts that differ from cell to cell.
constexpr double fluence = 3.0, massScale = 40.0, photon = 0.5;
const dvec4 radiance(2.0, 1.0, 0.25, 1.0);

std::int64_t countIn(std::size_t cell) {
    return static_cast<std::int64_t>(7 * cell % 800);
}

/// A shell round a hole wide enough for cells with nothing near, against one face of the volume.
Grid<double> shell() {
    Grid<double> density({33, 30, 35});
    forEach(ivec3(1), density.size - 1, [&](const ivec3& v) {
        const double distance = glm::distance(glm::dvec3(v), glm::dvec3(15.0, 12.0, 17.0));
        density.values[density.index(v)] = distance > 10.0 && distance < 14.0 ? 1.0 - 0.5 * (v.x % 2) : 0.0;
    });
    return density;
}

class LongCloud : public test::VulkanTest {};

class LightFieldTest : public test::VulkanTest, public testing::WithParamInterface<int> {
  protected:
    Grid<double> density = shell();
    int edge = GetParam();

    /// Edges of a cell in transport free paths for each unit of its mass (massScale, with voxels of a metre).
    double thickness() const { return massScale / (edge * edge); }

    /// Cells before they are smoothed.
    struct Raw {
        explicit Raw(const ivec3& cells) : light(cells), mass(cells), centre(cells) {}
        Grid<dvec4> light;
        Grid<double> mass;
        Grid<glm::dvec3> centre;  // of the mass, from the middle of the cell [cells]

        double share(const ivec3& cell) const {
            constexpr double own = 150.0;  // photons
            const auto count = static_cast<double>(countIn(mass.index(cell)));
            return light(cell).a > 0.0 ? count / (count + own) : 0.0;
        }
    };

    Raw raw(const ivec3& cells) const {
        constexpr double prior = 10.0;  // photons
        Raw raw(cells);
        forEach(ivec3(0), cells, [&](const ivec3& cell) {
            bool occupied = false;
            double mass = 0.0;
            glm::dvec3 moment(0.0);
            forEach(edge * cell, glm::min(edge * (cell + 1), density.size), [&](const ivec3& voxel) {
                mass += density.smoothed(voxel, 0.125);
                occupied = occupied || density(voxel) > 0.0;
                // two look-ups along each axis, at a quarter of the voxel from its middle
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::dvec3 at = 0.5 * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) - 0.25;
                    moment += 0.125 * between(voxel, at) * (glm::dvec3(voxel - edge * cell) + 0.5 + at);
                }
            });
            const std::size_t i = raw.mass.index(cell);
            const double counted = photon * static_cast<double>(countIn(i));
            const double ratio = (counted + prior * photon) / (fluence * mass * massScale + prior * photon);
            if (occupied) raw.light.values[i] = radiance * dvec4(glm::dvec3(ratio), 1.0);
            raw.mass.values[i] = mass;
            if (mass > 0.0) raw.centre.values[i] = moment / (mass * edge) - 0.5;
        });
        return raw;
    }

    /// The density between voxels, from the middle of one.
    double between(const ivec3& voxel, const glm::dvec3& away) const {
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const ivec3 use(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::dvec3 share = glm::mix(1.0 - glm::abs(away), glm::abs(away), glm::dvec3(use));
            sum += share.x * share.y * share.z * density(voxel + use * ivec3(glm::sign(away)));
        }
        return sum;
    }

    /// What the passes should leave in a cell.
    dvec4 smoothed(const Raw& raw, const ivec3& cell) const {
        const int reach = raw.light(cell).a > 0.0 ? 1 : 2;
        double weights = 0.0, sharpness = 0.0;
        dvec4 light(0.0);
        glm::dvec3 place(0.0);
        glm::dmat3 places(0.0), slopes(0.0);
        const ivec3 lower = glm::max(cell - reach, ivec3(0)), upper = glm::min(cell + reach + 1, raw.mass.size);
        forEach(lower, upper, [&](const ivec3& other) {
            if (raw.light(other).a == 0.0) return;
            const ivec3 near = reach + 1 - glm::abs(other - cell);
            const double weight = near.x * near.y * near.z;
            const glm::dvec3 at = glm::dvec3(other - cell) + raw.centre(other);
            weights += weight;
            sharpness +=
                std::pow(thickness() * raw.mass(other), 2) * static_cast<double>(countIn(raw.mass.index(other)));
            light += weight * raw.light(other);
            place += weight * at;
            places += weight * glm::outerProduct(at, at);
            slopes += weight * glm::outerProduct(glm::dvec3(raw.light(other)), at);
        });
        if (weights == 0.0) return dvec4(0.0);
        const glm::dvec3 mean = glm::dvec3(light) / weights;
        place /= weights;
        places = places / weights - glm::outerProduct(place, place) + (0.02 + 8.0 / sharpness) * glm::dmat3(1.0);
        const glm::dmat3 slope = (slopes / weights - glm::outerProduct(mean, place)) * glm::inverse(places);
        const glm::dvec3 plane = glm::max(mean - slope * place, 0.2 * mean);
        const glm::dvec3 own = glm::max(glm::dvec3(raw.light(cell)) - slope * raw.centre(cell), 0.2 * mean);
        return {glm::mix(plane, own, raw.share(cell)), 1.0};
    }

    /// What the passes should leave: light, and 1 where cells with density are near.
    Grid<dvec4> expected(const Raw& from) const {
        const ivec3 cells = from.mass.size;
        Grid<dvec4> field(cells);
        forEach(ivec3(0), cells, [&](const ivec3& cell) {
            bool lit = false;
            forEach(glm::max(cell - 1, ivec3(0)), glm::min(cell + 2, cells),
                    [&](const ivec3& other) { lit = lit || from.mass(other) > 0.0; });
            if (lit) field.values[field.index(cell)] = smoothed(from, cell);
        });
        return field;
    }

    gpu::Image collectorImage(const dvec4& value, std::size_t collectors) {
        const int width = static_cast<int>(shared::COLLECTORS_WIDTH);
        gpu::Image image(context, "of collectors", glm::ivec2(width, 1), VK_FORMAT_R32G32B32A32_SFLOAT);
        EXPECT_LT(collectors, shared::COLLECTORS_WIDTH);
        gpu::upload(context, image, std::vector<glm::vec4>(shared::COLLECTORS_WIDTH, glm::vec4(value)));
        return image;
    }

    /// Puts in the centres that the layout has, of eight bits, after a look at each.
    void takeCentres(const CellLayout& layout, Raw& raw) {
        const std::vector<glm::u8vec4> stored = gpu::download<glm::u8vec4>(context, layout.massCentres);
        for (std::size_t i = 0; i < stored.size(); ++i) {
            if (raw.mass.values[i] == 0.0) continue;
            const glm::dvec3 centre = glm::dvec3(glm::u8vec3(stored[i])) / 255.0 - 0.5;
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_NEAR(centre[axis], raw.centre.values[i][axis], 0.51 / 255.0) << i << " " << axis;
            raw.centre.values[i] = centre;
        }
    }

    Grid<glm::vec4> filled(const std::shared_ptr<const CellLayout>& layout, const cloud::Asset& cloud) {
        const cloud::CellGrid& cells = layout->grid;
        std::vector<std::int64_t> counts(shared::estimatorCounts(cells.cells));
        const Grid<double> numbers(cells.cells);
        forEach(ivec3(0), cells.cells, [&](const ivec3& cell) {
            counts[shared::cubePlace(cells.cells, cell) + shared::placeInCube(cell)] = countIn(numbers.index(cell));
        });
        gpu::Buffer estimates(context, "estimates", counts.size() * sizeof(std::int64_t), gpu::Memory::device);
        gpu::upload(context, estimates, counts);
        const gpu::Image fluences = collectorImage(dvec4(0.0, 0.0, 0.0, fluence), cloud.collectors.size());
        const gpu::Image towardsEye = collectorImage(radiance, cloud.collectors.size());
        const gpu::Image colours = collectorImage(dvec4(1.0, 2.0, 4.0, 1.0), cloud.collectors.size());
        const LightCells lit(context, cloud, layout, cells, cloud.voxelToMetres, 0);
        const LightField field(context, cells);
        gpu::Commands commands(context);
        commands.begin();
        lit.recordCounts(commands, fluences, {estimates, 0, photon, photon, massScale, 0.0});
        field.record(commands, lit, glm::vec3(-50.0F, 20.0F, 10.0F), towardsEye, colours);
        commands.submit();
        commands.wait();
        Grid<glm::vec4> result(cells.cells);
        result.values = gpu::download<glm::vec4>(context, field.image());
        return result;
    }
};

/// Each cell of the whole grid, whatever its edge: with density, beside it, and in the hole.
TEST_P(LightFieldTest, HoldsWhatWasCountedAndNothingElse) {
    vdb::Volume volume = test::emptyVolume(density.size);
    test::fillVolume(volume, density);
    const cloud::Asset cloud = cloud::prepare(context, volume, test::prepareOptions(200));
    const cloud::CellGrid cells{edge, (density.size + edge - 1) / edge};
    const std::shared_ptr<const CellLayout> layout = CellLayouts().of(context, cloud, cells);
    Raw cellsAsCounted = raw(cells.cells);
    takeCentres(*layout, cellsAsCounted);
    const Grid<dvec4> known = expected(cellsAsCounted);
    const Grid<glm::vec4> found = filled(layout, cloud);
    // beyond the surface the field is a difference of much larger numbers
    double largest = 0.0;
    for (const dvec4& light : cellsAsCounted.light.values) largest = std::max(largest, light.r);
    const double rounding = 3e-5 * largest;
    std::size_t dark = 0;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        for (int k = 0; k < 4; ++k)
            ASSERT_NEAR(static_cast<double>(found.values[cell][k]), known.values[cell][k],
                        1e-4 * known.values[cell][k] + rounding)
                << cell << " " << k;
        if (known.values[cell].a == 0.0) ++dark;
    }
    EXPECT_GT(dark, cells.count() / 16);
    EXPECT_LT(dark, cells.count() * 7 / 8);
}

/// Where few photons met, the collectors' light towards the eye cancels but for a rest in the colour of one of them.
/// What the count of directions adds then has the colour of all light there.
TEST_F(LongCloud, WhatIsCountedHasTheColourOfAllLight) {
    vdb::Volume volume = test::emptyVolume({8, 8, 8});
    test::fillVolume(volume, [](const ivec3&) { return 1.0; });
    const cloud::Asset cloud = cloud::prepare(context, volume, test::prepareOptions(50));
    const cloud::CellGrid cells{2, ivec3(4)};
    const auto image = [&](const glm::vec4& value) {
        gpu::Image made(context, "of collectors", glm::ivec2(static_cast<int>(shared::COLLECTORS_WIDTH), 1),
                        VK_FORMAT_R32G32B32A32_SFLOAT);
        gpu::upload(context, made, std::vector<glm::vec4>(shared::COLLECTORS_WIDTH, value));
        return made;
    };
    const gpu::Image fluences = image({0.0F, 0.0F, 0.0F, 3.0F}), towardsEye = image({1e-3F, 1e-5F, 1e-6F, 1.0F}),
                     colours = image({1.0F, 2.0F, 4.0F, 1.0F});
    std::vector<std::int64_t> counts(shared::estimatorCounts(cells.cells));
    forEach(ivec3(0), cells.cells, [&](const ivec3& cell) {
        const auto cube = shared::cubePlace(cells.cells, cell);
        counts[cube + shared::placeInCube(cell)] = 100;
        counts[cube + static_cast<unsigned>(shared::CUBE_CELLS)] = 600;  // towards +x, where the eye is
    });
    gpu::Buffer estimates(context, "estimates", counts.size() * sizeof(std::int64_t), gpu::Memory::device);
    gpu::upload(context, estimates, counts);
    const LightCells lit(context, cloud, cells, cells);
    const LightField field(context, cells);
    gpu::Commands commands(context);
    commands.begin();
    lit.recordCounts(commands, fluences, {estimates, 0, photon, photon, massScale, 0.8});
    field.record(commands, lit, glm::vec3(1000.0F, 4.0F, 4.0F), towardsEye, colours);
    commands.submit();
    commands.wait();
    for (const glm::vec4& light : gpu::download<glm::vec4>(context, field.image())) {
        EXPECT_GT(light.r, 0.0F);
        EXPECT_NEAR(light.r / light.b, 0.25F, 0.01F);
        EXPECT_NEAR(light.g / light.b, 0.5F, 0.01F);
    }
}

/// As long as volumes may be where devices have 2048 texels along them, with more photons than voxels.
TEST_F(LongCloud, HasRoomForTheRing) {
    vdb::Volume volume = test::emptyVolume({2048, 4, 4});
    test::fillVolume(volume, [](const ivec3&) { return 1.0; });
    const cloud::Asset cloud = cloud::prepare(context, volume, test::prepareOptions(50));
    const cloud::CellGrid cells = lightGrid(cloud, 1'000'000'000);
    EXPECT_EQ(cells.edge, 2);
    const LightCells lit(context, cloud, cells, cells);
    const LightField field(context, cells);
    EXPECT_EQ(field.image().extent(), ivec3(1024, 2, 2));
}

INSTANTIATE_TEST_SUITE_P(Edges, LightFieldTest, testing::Values(1, 2, 4));

}  // namespace
}  // namespace lumulus::light
