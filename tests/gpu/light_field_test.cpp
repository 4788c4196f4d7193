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

    /// What the passes should leave: (Σ L, Σ 1) of smoothed cells.
    Grid<dvec4> expected(const ivec3& cells) const {
        constexpr double prior = 10.0, own = 150.0;  // photons
        Grid<dvec4> raw(cells), field(cells);
        Grid<double> mass(cells);
        forEach(ivec3(0), cells, [&](const ivec3& cell) {
            bool occupied = false;
            forEach(edge * cell, glm::min(edge * (cell + 1), density.size), [&](const ivec3& voxel) {
                mass.values[mass.index(cell)] += density.smoothed(voxel, 0.125);
                occupied = occupied || density(voxel) > 0.0;
            });
            const double counted = photon * static_cast<double>(countIn(raw.index(cell)));
            const double ratio = (counted + prior * photon) / (fluence * mass(cell) * massScale + prior * photon);
            if (occupied) raw.values[raw.index(cell)] = radiance * dvec4(glm::dvec3(ratio), 1.0);
        });
        forEach(ivec3(0), cells, [&](const ivec3& cell) {
            const auto count = static_cast<double>(countIn(raw.index(cell)));
            const double share = raw(cell).a > 0.0 ? count / (count + own) : 0.0;
            field.values[field.index(cell)] = glm::mix(raw.smoothed(cell, 0.25), raw(cell), share);
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

    Grid<glm::vec4> filled(const cloud::CellGrid& cells, const cloud::Asset& cloud) {
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
        const LightCells lit(context, cloud, cells, cells);
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
    const Grid<dvec4> known = expected(cells.cells);
    const Grid<glm::vec4> found = filled(cells, cloud);
    std::size_t dark = 0;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        for (int k = 0; k < 4; ++k)
            ASSERT_NEAR(static_cast<double>(found.values[cell][k]), known.values[cell][k],
                        1e-4 * known.values[cell][k] + 1e-7)
                << cell << " " << k;
        if (known.values[cell].a == 0.0) ++dark;
    }
    EXPECT_GT(dark, cells.count() / 8);
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
