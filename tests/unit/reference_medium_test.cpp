#include "reference/medium.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "reference/majorant.h"
#include "stat/ball.h"

namespace lumulus::reference {
namespace {

/// A field without symmetry, with a ring of zeros.
vdb::Volume hillyVolume() {
    vdb::Volume volume = boxVolume({9, 7, 13});
    for (int z = 1; z < volume.size.z - 1; ++z) {
        for (int y = 1; y < volume.size.y - 1; ++y) {
            for (int x = 1; x < volume.size.x - 1; ++x) {
                volume.density[volume.index(x, y, z)] = static_cast<float>((x * 7 + y * 13 + z * 29) % 17) / 8.0F;
            }
        }
    }
    volume.toWorld.linear = glm::dmat3(2.0, 0.1, 0.0, -0.3, 1.5, 0.2, 0.0, 0.4, 3.0);
    volume.toWorld.translation = glm::dvec3(1e7, -20.0, 5.0);
    return volume;
}

/// The field by the definition in vdb/volume.h, zero outside.
double interpolate(const vdb::Volume& volume, const glm::dvec3& p) {
    const glm::dvec3 q = p - 0.5;
    const glm::ivec3 base(glm::floor(q));
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::ivec3 voxel = base + offset;
        if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, volume.size)))
            continue;
        double weight = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double f = q[axis] - base[axis];
            weight *= offset[axis] == 1 ? f : 1.0 - f;
        }
        sum += weight * static_cast<double>(volume.density[volume.index(voxel.x, voxel.y, voxel.z)]);
    }
    return sum;
}

TEST(Medium, InterpolatesAsTheVolumeIsDefined) {
    const vdb::Volume volume = hillyVolume();
    const Medium medium(volume, 1.0);
    Random random(3, 0, 0);
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 p = glm::dvec3(random.uniform(), random.uniform(), random.uniform()) * glm::dvec3(volume.size);
        ASSERT_NEAR(medium.density(p), interpolate(volume, p), 1e-6);
    }
    EXPECT_EQ(medium.density(glm::dvec3(0.0)), 0.0);
    EXPECT_EQ(medium.density(glm::dvec3(volume.size)), 0.0);
    EXPECT_FLOAT_EQ(static_cast<float>(medium.density(glm::dvec3(3.5, 2.5, 4.5))),
                    volume.density[volume.index(3, 2, 4)]);
}

TEST(Medium, TakesWorldCoordinatesToVoxels) {
    const vdb::Volume volume = hillyVolume();
    const Medium medium(volume, 1.0);
    const glm::dvec3 p(3.25, 2.5, 7.75);
    const VoxelRay ray = medium.toVoxel(Ray{volume.toWorld.point(p), glm::normalize(glm::dvec3(1.0, 2.0, -3.0))});
    EXPECT_LT(glm::distance(ray.origin, p), 1e-8);
    EXPECT_LT(glm::distance(volume.toWorld.vector(ray.step), glm::normalize(glm::dvec3(1.0, 2.0, -3.0))), 1e-14);
}

/// The local majorant is a bound everywhere, and within a cell some voxel comes near it.
TEST(Majorant, BoundsTheInterpolatedField) {
    const vdb::Volume volume = hillyVolume();
    const Medium medium(volume, 0.3);
    Random random(4, 0, 0);
    for (const Majorant kind : {Majorant::local, Majorant::global}) {
        const MajorantGrid grid(medium, kind);
        double tightest = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const glm::dvec3 p =
                glm::dvec3(random.uniform(), random.uniform(), random.uniform()) * glm::dvec3(volume.size);
            const VoxelRay ray{
                p, medium.stepOf(glm::normalize(glm::dvec3(random.uniform() - 0.5, 0.4, random.uniform())))};
            grid.walk(ray, *medium.clip(ray), random, [&](double t, double majorant) {
                const double extinction = 0.3 * interpolate(volume, ray.at(t));
                EXPECT_LE(extinction, majorant);
                tightest = std::max(tightest, extinction / majorant);
                return false;
            });
        }
        EXPECT_GT(tightest, 0.9);
    }
}

TEST(Majorant, WalksThroughSpikesAtCellBorders) {
    // one voxel of 1e6 in a field of 1, next to the border between two cells of six voxels
    for (const int at : {5, 6, 7}) {
        vdb::Volume volume = boxVolume({12, 12, 12});
        volume.density[volume.index(at, 6, 6)] = 1e6F;
        const Medium medium(volume, 1e-5);
        const MajorantGrid grid(medium, Majorant::local);
        const VoxelRay ray{{0.0, 6.5, 6.9}, {1.0, 0.0, 0.0}};
        Random random(1, 0, 0);
        grid.walk(ray, *medium.clip(ray), random, [&](double t, double majorant) {
            EXPECT_LE(1e-5 * interpolate(volume, ray.at(t)), majorant);
            return false;
        });
    }
}

TEST(LineIntegrals, OfABoxAreAnalytic) {
    // the trilinear field of a box keeps the mass of each row: n voxels are n metres
    const vdb::Volume volume = boxVolume({10, 20, 20});
    const Medium medium(volume, 0.2);
    const LineIntegrals along =
        integrateAlong(std::array{opticalPieces(medium, medium.toVoxel(Ray{{-5.0, 11.0, 11.0}, {1.0, 0.0, 0.0}}))});
    EXPECT_NEAR(along.transmittance, std::exp(-2.0), 1e-6);
    const glm::dvec3 slanted = glm::normalize(glm::dvec3(-2.0, 1.0, 0.3));
    const glm::dvec3 middle(6.0, 11.0, 11.0);
    const LineIntegrals across =
        integrateAlong(std::array{opticalPieces(medium, medium.toVoxel(Ray{middle - 15.0 * slanted, slanted}))});
    EXPECT_NEAR(across.transmittance, std::exp(-2.0 / std::abs(slanted.x)), 1e-6);
    // mean depth of the first collision in a homogeneous layer, six metres from the origin; the ramps of the field at
    // its faces move it by centimetres
    const double expected = (1.0 / 0.2 - 10.0 / std::expm1(2.0)) + 6.0;
    EXPECT_NEAR(along.distance / (1.0 - along.transmittance), expected, 0.03);
}

TEST(LineIntegrals, OfABallAreAnalytic) {
    const double radius = 10.0, extinction = 0.1;
    const Medium medium(ballVolume(66, radius), extinction);
    for (const double b : {0.0, 3.3, 6.1, 8.7}) {
        const Ray ray{{b * 0.6, b * 0.8, 40.0}, {0.0, 0.0, -1.0}};
        const double expected = std::exp(-2.0 * extinction * std::sqrt(radius * radius - b * b));
        EXPECT_NEAR(integrateAlong(std::array{opticalPieces(medium, medium.toVoxel(ray))}).transmittance, expected,
                    0.003)
            << "at " << b;
    }
    EXPECT_EQ(
        integrateAlong(std::array{opticalPieces(medium, medium.toVoxel(Ray{{0.0, 10.5, 40.0}, {0.0, 0.0, -1.0}}))})
            .transmittance,
        1.0);
}

TEST(LineIntegrals, DoNotDependOnTheDirection) {
    const vdb::Volume volume = hillyVolume();
    const Medium medium(volume, 0.05);
    const glm::dvec3 centre = volume.toWorld.point(0.5 * glm::dvec3(volume.size));
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.4, -0.2, 0.7));
    const auto there =
        integrateAlong(std::array{opticalPieces(medium, medium.toVoxel(Ray{centre - 200.0 * direction, direction}))});
    const auto back =
        integrateAlong(std::array{opticalPieces(medium, medium.toVoxel(Ray{centre + 200.0 * direction, -direction}))});
    EXPECT_LT(there.transmittance, 0.9);
    EXPECT_NEAR(there.transmittance, back.transmittance, 1e-7);
}

/// Metres to the cloud along the ray from a point in voxel coordinates; −1 where there is none.
double frontOf(const Medium& medium, const vdb::Volume& volume, const glm::dvec3& from, const glm::dvec3& direction) {
    const Ray ray{volume.toWorld.point(from), glm::normalize(volume.toWorld.vector(direction))};
    return frontAlong(medium, medium.toVoxel(ray)).value_or(-1.0);
}

TEST(Front, OfABoxIsHalfAVoxelBeforeIt) {
    // between the centre of the ring's voxel at .5 and the first one at 1.5 the density rises from 0 to 1
    const vdb::Volume volume = boxVolume({10, 20, 20});
    const Medium medium(volume, 0.2);
    const auto front = [&](const glm::dvec3& from, const glm::dvec3& direction) {
        return frontOf(medium, volume, from, direction);
    };
    EXPECT_NEAR(front({-5.0, 11.0, 11.0}, {1.0, 0.0, 0.0}), 5.5, 1e-12);
    EXPECT_NEAR(front({17.0, 11.3, 10.9}, {-1.0, 0.0, 0.0}), 17.0 - 11.5, 1e-12);
    EXPECT_NEAR(front({0.5, 0.5, -4.0}, {1e-9, 1e-9, 1.0}), 4.5, 1e-6) << "along an edge, just inside";
    EXPECT_EQ(front({0.5, 0.5, -4.0}, {0.0, 0.0, 1.0}), -1.0) << "in the plane where the density is 0";
    EXPECT_NEAR(front({1.5, 1.5, -4.0}, {0.0, 0.0, 1.0}), 4.5, 1e-12) << "in a plane of voxel centres";
    const glm::dvec3 slanted = glm::normalize(glm::dvec3(2.0, 1.0, 0.3));
    EXPECT_NEAR(front({-5.0, 6.0, 11.0}, slanted), 5.5 / slanted.x, 1e-12);
    EXPECT_EQ(front({6.0, 11.0, 11.0}, slanted), 0.0) << "from inside";
    EXPECT_EQ(front({-5.0, 6.0, 11.0}, -slanted), -1.0) << "away from it";
    EXPECT_EQ(front({-5.0, 30.0, 11.0}, {1.0, 0.0, 0.0}), -1.0) << "past it";
}

TEST(Front, OfABallIsItsSurface) {
    const double radius = 10.0, voxel = 20.0 / 64.0;
    const Medium medium(ballVolume(66, radius), 0.1);
    for (const double b : {0.0, 3.3, 6.1, 8.7}) {
        const Ray ray{{b * 0.6, b * 0.8, 40.0}, {0.0, 0.0, -1.0}};
        const double front = frontAlong(medium, medium.toVoxel(ray)).value_or(0.0);
        // the field reaches up to 1.5 voxels beyond the surface in each axis, by which a slanted surface moves further
        const double surface = std::sqrt(radius * radius - b * b), slope = radius / surface;
        EXPECT_LE(front, 40.0 - surface) << "at " << b;
        EXPECT_GE(front, 40.0 - surface - 1.5 * std::sqrt(3.0) * voxel * slope) << "at " << b;
    }
}

/// Against looking at every hundredth of a voxel, in a field with holes.
TEST(Front, IsWhereTheDensityBegins) {
    vdb::Volume volume = hillyVolume();
    for (std::size_t i = 0; i < volume.density.size(); ++i) {
        if (i % 97 != 5) volume.density[i] = 0.0F;
    }
    const Medium medium(volume, 0.3);
    const glm::dvec3 size(volume.size);
    Random random(5, 0, 0);
    int met = 0;
    for (int i = 0; i < 900; ++i) {
        const auto somewhere = [&] { return glm::dvec3(random.uniform(), random.uniform(), random.uniform()); };
        const glm::dvec3 from = (2.0 * somewhere() - 0.5) * size;
        const glm::dvec3 direction = glm::normalize(somewhere() * size - from);
        double expected = -1.0;
        for (double t = 0.0; t < 60.0 && expected < 0.0; t += 0.01) {
            if (interpolate(volume, from + t * direction) > 0.0) expected = t;
        }
        const double scale = glm::length(volume.toWorld.vector(direction));
        const double front = frontOf(medium, volume, from, direction) / scale;
        if (expected < 0.0) {
            EXPECT_LT(front, 0.0);
        } else {
            EXPECT_NEAR(front, expected, 0.011);
            ++met;
        }
    }
    EXPECT_GT(met, 50);
    EXPECT_LT(met, 900);
}

}  // namespace
}  // namespace lumulus::reference
