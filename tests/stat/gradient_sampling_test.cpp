#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

#include "cloud/asset.h"
#include "support/cloud_cases.h"
#include "support/deviation.h"
#include "support/field.h"
#include "support/vulkan_fixture.h"

namespace lumulus::cloud {
namespace {

using glm::dvec3;
using glm::ivec3;
using GradientSampling = test::VulkanTest;

/// |∇ρ| per metre by central differences over a voxel, of the interpolated field.
double gradientAt(const test::Field& field, const dvec3& point, const glm::dmat3& toMetres) {
    dvec3 difference;
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 step(0.0);
        step[axis] = 1.0;
        difference[axis] = 0.5 * (field.at(point + step) - field.at(point - step));
    }
    return glm::length(toMetres * difference);
}

/// Bins of voxels that do not fall together with the blocks of the sampler.
struct Bins {
    static constexpr int edge = 3;
    ivec3 count;
    explicit Bins(const ivec3& size) : count((size + edge - 1) / edge) {}
    std::size_t size() const { return static_cast<std::size_t>(count.x * count.y * count.z); }
    std::size_t of(const dvec3& point) const {
        const ivec3 bin = glm::min(ivec3(point) / edge, count - 1);
        return static_cast<std::size_t>((bin.z * count.y + bin.y) * count.x + bin.x);
    }
};

/// ∫|∇ρ| over each bin by midpoints, as shares of the whole.
std::vector<double> expectedShares(const test::Field& field, const glm::dmat3& toMetres, const Bins& bins) {
    constexpr int parts = 3;  // a voxel's edge
    std::vector<double> shares(bins.size(), 0.0);
    double total = 0.0;
    const ivec3 points = field.size() * parts;
    for (int z = 0; z < points.z; ++z)
        for (int y = 0; y < points.y; ++y)
            for (int x = 0; x < points.x; ++x) {
                const dvec3 point = (dvec3(x, y, z) + 0.5) / double{parts};
                const double gradient = gradientAt(field, point, toMetres);
                shares[bins.of(point)] += gradient;
                total += gradient;
            }
    for (double& share : shares) share /= total;
    return shares;
}

/// χ² of the samples in space: below 4 standard deviations for each of the seeds.
TEST_F(GradientSampling, FollowsTheGradientInSpace) {
    for (const test::CloudCase& c : test::cloudCases()) {
        if (c.name == "spike") continue;
        SCOPED_TRACE(c.name);
        const test::Field field(c.volume);
        const glm::dmat3 toMetres = glm::inverseTranspose(c.volume.toWorld.linear);
        const Bins bins(field.size());
        const std::vector<double> shares = expectedShares(field, toMetres, bins);
        for (const std::uint32_t seed : {1U, 2U}) {
            PrepareOptions options = test::prepareOptions(100'000);
            options.preparation.maxLeaves = 16;
            options.seed = seed;
            const Asset cloud = prepare(context, c.volume, options);
            ASSERT_EQ(cloud.samples.size(), 100'000U);
            std::vector<double> seen(bins.size(), 0.0), due;
            for (const Sample& sample : cloud.samples) {
                seen[bins.of(dvec3(sample.position))] += 1.0;
                ASSERT_NEAR(static_cast<double>(sample.density), field.at(dvec3(sample.position)), 1e-4);
            }
            for (const double share : shares) due.push_back(share * 1e5);
            EXPECT_LT(std::abs(test::chiSquareDeviation(seen, due)), 4.0);
        }
    }
}

/// The spike takes its share and no more; no trial runs out, so that every sample has a gradient.
TEST_F(GradientSampling, ASpikeDoesNotStallIt) {
    const vdb::Volume volume = test::spikeVolume();
    const test::Field field(volume);
    const Asset cloud = prepare(context, volume, test::prepareOptions(100'000));
    const glm::dmat3 identity(1.0);
    const dvec3 spike(25.5, 22.5, 27.5);
    const auto nearSpike = [&](const dvec3& point) {
        const dvec3 away = glm::abs(point - spike);
        return std::max(away.x, std::max(away.y, away.z)) < 2.0;
    };
    double there = 0.0, elsewhere = 0.0;
    for (int z = 0; z < field.size().z * 2; ++z)
        for (int y = 0; y < field.size().y * 2; ++y)
            for (int x = 0; x < field.size().x * 2; ++x) {
                const dvec3 point = (dvec3(x, y, z) + 0.5) / 2.0;
                if (!nearSpike(point)) elsewhere += gradientAt(field, point, identity) / 8.0;
            }
    constexpr int parts = 40;
    for (int i = 0; i < parts * parts * parts; ++i) {
        const dvec3 place = (dvec3(i % parts, i / parts % parts, i / parts / parts) + 0.5) / double{parts};
        there += gradientAt(field, spike - 2.0 + 4.0 * place, identity) * 64.0 / (parts * parts * parts);
    }
    double far = 0.0;
    for (const Sample& sample : cloud.samples) {
        ASSERT_GT(gradientAt(field, dvec3(sample.position), identity), 0.0);
        if (!nearSpike(dvec3(sample.position))) far += 1.0;
    }
    const double share = elsewhere / (there + elsewhere);
    const double due = share * 100'000.0;
    EXPECT_GT(due, 200.0);
    EXPECT_NEAR(far, due, 4.0 * std::sqrt(due * (1.0 - share)) + 0.01 * due);  // 1 % for the quadrature
}

}  // namespace
}  // namespace lumulus::cloud
