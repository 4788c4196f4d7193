// Clouds that move: velocities in files, and what lies between two files.
#include "volume/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/frame_name.h"
#include "support/temporary_folder.h"
#include "support/test_volumes.h"
#include "vdb/deform.h"
#include "vdb/write.h"
#include "volume/load.h"

namespace lumulus {
namespace {

using glm::dvec3;

constexpr double voxel = 10.0;

class Motion : public testing::Test {
  protected:
    /// A lumpy ball at rest.
    static vdb::Volume ball() {
        vdb::Volume volume = test::emptyVolume({26, 24, 22});
        volume.toWorld = {glm::dmat3(voxel), dvec3(100.0, -50.0, 0.0)};
        test::fillVolume(volume, [](const glm::ivec3& v) {
            const dvec3 from = dvec3(v) - dvec3(12.5, 11.5, 10.5);
            return std::max(0.0, 1.0 - glm::length(from) / 9.0) * (1.0 + 0.3 * std::sin(0.9 * v.x));
        });
        return volume;
    }
    std::filesystem::path file(int number) const { return nameOfFrame(folder.path() / "v_####.vdb", number); }
    /// Files a second apart.
    void writeFiles(const vdb::Flow& flow, bool withVelocities) const {
        for (int number = 0; number < 2; ++number) {
            const vdb::Volume moved = vdb::deformed(ball(), flow, number);
            if (withVelocities)
                vdb::write(moved, vdb::velocitiesOf(moved, flow, number), file(number));
            else
                vdb::write(moved, file(number));
        }
    }
    scene::Cloud cloudAt(double moment) const {
        scene::Cloud cloud;
        const int number = static_cast<int>(std::floor(moment));
        cloud.vdb = file(number);
        cloud.moment = scene::SequenceMoment{folder.path() / "v_####.vdb", moment, 1.0, {}};
        if (moment > number) cloud.moment->next = file(number + 1);
        return cloud;
    }
    static vdb::Volume loaded(const scene::Cloud& cloud) {
        scene::Scene scene;
        scene.clouds = {cloud};
        return *loadClouds(scene).volumes.front();
    }
    /// Greatest difference of densities where `truth` has its voxels.
    static double difference(const vdb::Volume& volume, const vdb::Volume& truth) {
        double most = 0.0;
        for (int z = 0; z < truth.size.z; ++z)
            for (int y = 0; y < truth.size.y; ++y)
                for (int x = 0; x < truth.size.x; ++x) {
                    const dvec3 place = truth.toWorld.point(dvec3(x, y, z) + 0.5);
                    const dvec3 at = (place - volume.toWorld.translation) / voxel - 0.5;
                    const glm::ivec3 v = glm::ivec3(glm::round(at));
                    const bool inside =
                        glm::all(glm::greaterThanEqual(v, glm::ivec3(0))) && glm::all(glm::lessThan(v, volume.size));
                    const float here = inside ? volume.density[volume.index(v.x, v.y, v.z)] : 0.0F;
                    most = std::max(most, std::abs(static_cast<double>(here - truth.density[truth.index(x, y, z)])));
                }
        return most;
    }
    vdb::VoxelBox box() const { return {ball().toWorld, ball().size}; }

    test::TemporaryFolder folder;
};

/// The flow has no sources, and what it carries comes back where it was.
TEST_F(Motion, FlowsAreWhatTheyPromise) {
    const vdb::Flow flow(ball(), {10.0, 0.0, 0.0}, 4.0);
    const dvec3 place(130.0, 20.0, -70.0);
    constexpr double h = 1e-3;
    double divergence = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 step(0.0);
        step[axis] = h;
        divergence += (flow.velocity(place + step, 2.0) - flow.velocity(place - step, 2.0))[axis] / (2.0 * h);
    }
    EXPECT_NEAR(divergence, 0.0, 1e-8);
    // d origin / dt along a path is 0: a path of small steps ends where it began
    dvec3 at = flow.origin(place, 3.0);
    constexpr int steps = 3000;
    for (int i = 0; i < steps; ++i) {
        const double dt = 3.0 / steps, now = i * dt;
        at += dt * flow.velocity(at + 0.5 * dt * flow.velocity(at, now), now + 0.5 * dt);
    }
    EXPECT_LT(glm::length(at - place), 1e-4);
}

TEST_F(Motion, VelocitiesComeBackFromTheFile) {
    vdb::Flow flow(ball(), {10.0, -3.0, 0.0}, 4.0);
    flow.wave = 400.0;
    writeFiles(flow, true);
    const auto field = vdb::VelocityField::read(file(0), box(), {});
    ASSERT_TRUE(field);
    for (const dvec3& place : {dvec3(200.0, 60.0, 100.0), dvec3(252.0, 80.0, 131.0)})
        // linear between places 20 m apart: (k h)²/8 of two waves of 2.3 m/s in each component
        EXPECT_LT(glm::length(field->at(place) - flow.velocity(place, 0.0)), 0.1);
    EXPECT_EQ(loaded(cloudAt(0.0)).name, "density");
    writeFiles(flow, false);
    EXPECT_FALSE(vdb::VelocityField::read(file(0), box(), {}));
}

/// What moves by two voxels from file to file has moved by one between them, to rounding: with velocities of the file
/// and with those of the scene. Without either, both are seen at half their density.
TEST_F(Motion, BetweenTwoFilesDensitiesAreCarried) {
    const dvec3 wind(2.0 * voxel, 0.0, -2.0 * voxel);
    const vdb::Flow flow(ball(), wind, 0.0);
    writeFiles(flow, true);
    const vdb::Volume half = vdb::deformed(ball(), flow, 0.5);
    EXPECT_LT(difference(loaded(cloudAt(0.5)), half), 1e-6);
    EXPECT_LT(difference(loaded(cloudAt(0.0)), ball()), 1e-6);
    writeFiles(flow, false);
    scene::Cloud told = cloudAt(0.5);
    told.velocity = wind;
    EXPECT_LT(difference(loaded(told), half), 1e-6);
    EXPECT_GT(difference(loaded(cloudAt(0.5)), half), 0.1);
    const vdb::Volume shown = loaded(cloudAt(0.25));
    const glm::ivec3 middle(13, 12, 11);
    const dvec3 place = ball().toWorld.point(dvec3(middle) + 0.5);
    const glm::ivec3 at = glm::ivec3(glm::round((place - shown.toWorld.translation) / voxel - 0.5));
    const vdb::Volume still = ball();
    EXPECT_NEAR(shown.density[shown.index(at.x, at.y, at.z)],
                0.75F * still.density[still.index(13, 12, 11)] + 0.25F * still.density[still.index(11, 12, 13)], 1e-5F);
}

/// Velocities by height: each half of a cloud is carried by its own.
TEST_F(Motion, VelocitiesByHeight) {
    vdb::Volume halves = ball();
    const auto fill = [&](int low, int high) {
        test::fillVolume(halves, [&](const glm::ivec3& v) {
            const int from = v.y < 12 ? low : high;
            return v.x >= from && v.x < from + 5 && v.z > 3 && v.z < 18 && v.y != 11 && v.y != 12 ? 1.0 : 0.0;
        });
    };
    fill(4, 4);
    vdb::write(halves, file(0));
    fill(6, 14);
    vdb::write(halves, file(1));
    fill(5, 9);
    const double middle = -50.0 + 12.0 * voxel;
    scene::Cloud told = cloudAt(0.5);
    told.velocity = scene::Wind();
    told.velocity->levels = {{middle - 5.0, {2.0 * voxel, 0.0, 0.0}}, {middle + 5.0, {10.0 * voxel, 0.0, 0.0}}};
    EXPECT_LT(difference(loaded(told), halves), 1e-6);
    told.velocity = scene::Wind(dvec3(2.0 * voxel, 0.0, 0.0));
    EXPECT_GT(difference(loaded(told), halves), 0.4);
}

/// A flow that deforms: nearer to the truth than a blend by an order.
TEST_F(Motion, DeformingCloudsAreCarriedToo) {
    vdb::Flow flow(ball(), {0.0, 0.0, 0.0}, 60.0);
    flow.wave = 400.0;
    writeFiles(flow, true);
    const vdb::Volume truth = vdb::deformed(ball(), flow, 0.5);
    const double carried = difference(loaded(cloudAt(0.5)), truth);
    writeFiles(flow, false);
    EXPECT_LT(carried, 0.03);
    EXPECT_LT(4.0 * carried, difference(loaded(cloudAt(0.5)), truth));
}

TEST_F(Motion, WaysLeadBackToTheFrameBefore) {
    const dvec3 wind(2.0 * voxel, 0.0, 0.0);
    writeFiles(vdb::Flow(ball(), wind, 0.0), true);
    const CloudMotion motion = motionBetween(cloudAt(0.25), cloudAt(1.0), box(), {});
    EXPECT_TRUE(motion.goesOn);
    EXPECT_TRUE(motion.known);
    EXPECT_LT(glm::length(motion.way({200.0, 60.0, 100.0}) - 0.75 * wind), 1e-4);
    EXPECT_EQ(motionBetween(cloudAt(1.0), cloudAt(1.0), box(), {}).way(dvec3(1.0)), dvec3(0.0));
    scene::Cloud again = cloudAt(0.0);
    again.sequence.extend = scene::Extend::repeat;
    EXPECT_FALSE(motionBetween(cloudAt(1.0), again, box(), {}).goesOn);
    writeFiles(vdb::Flow(ball(), wind, 0.0), false);
    EXPECT_FALSE(motionBetween(cloudAt(0.0), cloudAt(1.0), box(), {}).known);
    scene::Cloud other;
    EXPECT_FALSE(motionBetween(other, cloudAt(1.0), box(), {}).known);
}

TEST_F(Motion, VelocitiesThatAreNoneAreRefused) {
    const vdb::Flow flow(ball(), {1.0, 0.0, 0.0}, 1.0);
    vdb::VelocityGrid grid = vdb::velocitiesOf(ball(), flow, 0.0);
    grid.values[grid.values.size() / 2].y = std::numeric_limits<float>::quiet_NaN();
    vdb::write(ball(), grid, file(0));
    EXPECT_THAT([&] { vdb::VelocityField::read(file(0), box(), {}); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("no number")));
    grid = vdb::velocitiesOf(ball(), flow, 0.0);
    grid.toWorld.translation += dvec3(1e5, 0.0, 0.0);
    vdb::write(ball(), grid, file(0));
    EXPECT_THAT([&] { vdb::VelocityField::read(file(0), box(), {}); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("outside of the cloud")));
    EXPECT_THROW(vdb::VelocityField::read(folder.path() / "gone.vdb", box(), {}), InputError);
}

}  // namespace
}  // namespace lumulus
