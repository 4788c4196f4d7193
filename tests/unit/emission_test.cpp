#include "light/photon/emission.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/photon_setup.h"

namespace lumulus::photon {
namespace {

using glm::dmat3;
using glm::dvec3;

const dmat3 boxFaces = faceAreas(dmat3(1.0), {2, 3, 5});

TEST(Emission, FluxesAreThoseThroughTheBox) {
    const dvec3 to = glm::normalize(dvec3(1, 2, -3));
    const Emission emission = makeEmission(test::sunFrom(to, {3, 2, 1}), test::skyOf({0.5, 1.0, 2.0}), boxFaces);
    const double projected = 15.0 * std::abs(to.x) + 10.0 * std::abs(to.y) + 6.0 * std::abs(to.z);
    const double surface = 2.0 * (15.0 + 10.0 + 6.0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(emission.sunFlux[c], (3.0 - c) * projected, 1e-12);
        EXPECT_NEAR(emission.skyFlux[c], 0.5 * (1 << c) * std::numbers::pi * surface, 1e-12);
    }
}

/// The area vector of a sheared box's face is the cross product of its edges; volume = area · the third edge. They
/// point along the edges in a mirrored box too.
TEST(Emission, FacesOfAShearedBox) {
    const dvec3 size(2, 3, 5);
    for (const double sign : {1.0, -1.0}) {
        const dmat3 voxel(dvec3(sign, 0.15, 0), dvec3(0.5, 3, 0.2), dvec3(-0.4, 0, 5));
        const dmat3 faces = faceAreas(voxel, size);
        for (int axis = 0; axis < 3; ++axis)
            for (int other = 0; other < 3; ++other)
                EXPECT_NEAR(glm::dot(faces[axis], voxel[other] * size[other]),
                            axis == other ? 30.0 * std::abs(glm::determinant(voxel)) : 0.0, 1e-10);
    }
}

TEST(Emission, ADarkLightHasNoPhotons) {
    const scene::Sun sun = test::sunFrom({0, 1, 0}, dvec3(1.0));
    const scene::Sky sky = test::skyOf(dvec3(1.0));
    const Emission onlySun = makeEmission(sun, test::skyOf(dvec3(0.0)), boxFaces);
    const Emission onlySky = makeEmission(test::noSun(), sky, boxFaces);
    for (const double u : {0.0, 0.5, 1.0 - 0x1p-32}) {
        EXPECT_EQ(onlySun.sunPhotons(1000, u), 1000U);
        EXPECT_EQ(onlySky.sunPhotons(1000, u), 0U);
    }
    EXPECT_EQ(onlySun.skyPower(1000), dvec3(0.0));
    EXPECT_EQ(onlySky.sunPower(1000), dvec3(0.0));
    EXPECT_FALSE(onlySun.dark());
    EXPECT_TRUE(makeEmission(test::noSun(), test::skyOf(dvec3(0.0)), boxFaces).dark());
}

/// Shares follow luminance; the photons of a light carry its flux on the average over `u`, also when the share is not
/// a whole number of them.
TEST(Emission, PhotonsCarryTheFlux) {
    const Emission emission = makeEmission(test::sunFrom({0, 1, 0}, {3, 1, 2}), test::skyOf({0.1, 0.2, 0.3}), boxFaces);
    constexpr std::uint64_t photons = 37;
    constexpr int steps = 1000;
    double sun = 0.0;
    for (int i = 0; i < steps; ++i) sun += static_cast<double>(emission.sunPhotons(photons, (i + 0.5) / steps)) / steps;
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(emission.sunPower(photons)[c] * sun, emission.sunFlux[c], 2e-3 * emission.sunFlux[c]);
        EXPECT_NEAR(emission.skyPower(photons)[c] * (double{photons} - sun), emission.skyFlux[c],
                    2e-3 * emission.skyFlux[c]);
    }
    const dvec3 luminance(0.2126, 0.7152, 0.0722);
    EXPECT_NEAR(glm::dot(emission.sunPower(photons), luminance), glm::dot(emission.skyPower(photons), luminance), 1e-9);
}

}  // namespace
}  // namespace lumulus::photon
