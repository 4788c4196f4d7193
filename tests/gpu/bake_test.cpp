// Light in a cloud as grids, where it is known: the furnace, and a box in the sun.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/leaf_voxels.h"
#include "bake/light_grid.h"
#include "base/error.h"
#include "support/deviation.h"
#include "support/small_scene.h"
#include "support/statistics.h"

namespace lumulus {
namespace {

using glm::dvec3;
using glm::vec3;
using std::numbers::pi;

constexpr int seeds = 16;

/// A scene as `lumulus bake` makes it of others.
scene::Scene bakedScene() {
    scene::Scene scene = test::smallScene();
    scene.preparation.levelOfDetail = false;
    scene.sky.model = scene::SkyModel::constant;
    scene.sky.radiance = dvec3(0.0);
    scene.sun.irradiance = dvec3(0.0);
    scene.sun.angularDiameter = 0.0;
    return scene;
}

/// Cubes of 10 m, 8 × 6 × 4, about the origin.
scene::Cloud boxOfCubes(double extinction) {
    scene::Voxels voxels;
    voxels.name = "box";
    voxels.size = {8, 6, 4};
    voxels.edges = dvec3(10.0);
    voxels.origin = {-35.0, -25.0, -15.0};
    voxels.values.assign(8 * 6 * 4, 1.0F);
    scene::Cloud cloud;
    cloud.voxels = std::make_shared<const scene::Voxels>(voxels);
    cloud.extinction = extinction;
    return cloud;
}

bake::LightGrid baked(const scene::Scene& scene, double voxel) {
    Renderer renderer(scene, {});
    for (int i = 0; i < renderer.generationsWanted(); ++i) renderer.traceGeneration();
    return bake::bakeLight(renderer, voxel, noReport, [] {});
}

/// Of a mean over runs from what is expected, in standard deviations.
double deviation(const test::RunningMean& mean, double expected) {
    const double t = (mean.mean() - expected) / mean.standardError();
    return std::abs(test::studentDeviation(t, seeds - 1));
}

TEST(Bake, FurnaceIsFullOfTheSkysLight) {
    const dvec3 sky(3.0, 1.0, 0.25);
    test::RunningMean fluence[3], flux[3];  // of runs of other seeds
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
        scene::Scene scene = bakedScene();
        scene.sky.radiance = sky;
        scene.photonMap.seed = seed;
        scene.photonMap.photons = 200000;
        const bake::LightGrid grid = baked(scene, 20.0);
        dvec3 sum(0.0), way(0.0);
        for (const bake::VoxelLight& light : grid.light) {
            sum += dvec3(light.fluence());
            way += dvec3(light.flux(0, vec3(grid.toSun)));
        }
        for (int c = 0; c < 3; ++c) {
            fluence[c].add(sum[c] / static_cast<double>(grid.light.size()) / (4.0 * pi * sky[c]));
            flux[c].add(way[c] / static_cast<double>(grid.light.size()) / (4.0 * pi * sky[0]));
        }
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(fluence[c].standardError(), 0.005);
        EXPECT_LT(deviation(fluence[c], 1.0), 4.0);
        EXPECT_LT(flux[c].standardError(), 0.005);
        EXPECT_LT(deviation(flux[c], 0.0), 4.0);
    }
}

TEST(Bake, SunIsDimmedByWhatItCrosses) {
    scene::Scene scene = bakedScene();
    const dvec3 sun(3.0, 2.0, 1.0);
    scene.clouds = {boxOfCubes(0.02)};
    scene.sun.directionTo = dvec3(1.0, 0.0, 0.0);
    scene.sun.irradiance = sun;
    const bake::LightGrid grid = baked(scene, 10.0);
    ASSERT_EQ(grid.toSun, scene.sun.directionTo);
    int inside = 0;
    for (std::size_t i = 0; i < grid.places.size(); ++i) {
        const dvec3 at = 10.0 * dvec3(grid.places[i]);
        // the density falls to 0 within 10 m of the outermost values
        if (std::abs(at.x) > 30.0 || std::abs(at.y) > 19.0 || std::abs(at.z) > 9.0) continue;
        const double way = 35.0 - at.x + 5.0;
        double mean = 0.0;  // of the points before and behind the middle
        for (const double shift : {-2.5, 2.5}) mean += 0.5 * std::exp(-0.02 * (way - shift));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(grid.light[i].sun[c], sun[c] * mean, 2e-3 * sun[c]);
        // the sun's part of fluence and flux
        const dvec3 fluence(grid.light[i].fluence());
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(fluence[c], static_cast<double>(grid.light[i].sun[c]) * 0.999);
            EXPECT_LT(grid.light[i].flux(c, vec3(grid.toSun)).x, 0.0F);
        }
        ++inside;
    }
    EXPECT_GT(inside, 10);
}

TEST(Bake, HarmonicsPointToWhereLightComesFrom) {
    scene::Scene scene = bakedScene();
    scene.clouds = {boxOfCubes(0.02)};
    scene.clouds[0].phase.g = 0.6;
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 2.0, -0.5));
    scene.sun.irradiance = dvec3(1.0);
    scene.photonMap.photons = 40000;
    const bake::LightGrid grid = baked(scene, 10.0);
    dvec3 from(0.0);
    double second = 0.0;
    for (const bake::VoxelLight& light : grid.light) {
        from += dvec3(light.coefficients[3].x, light.coefficients[1].x, light.coefficients[2].x);
        second += static_cast<double>(light.coefficients[4].x);  // x y
    }
    EXPECT_GT(glm::dot(glm::normalize(from), scene.sun.directionTo), 0.95);
    EXPECT_GT(second, 0.0);
}

TEST(Bake, LeavesKeepTheirPlacesAndMeans) {
    photon::LeafLight leaf;
    leaf.corner = {0.0, 0.0, 0.0};
    leaf.edges = glm::dmat3(dvec3(0.0, 4.0, 0.0), dvec3(-2.0, 0.0, 0.0), dvec3(0.0, 0.0, 2.0));  // on its side
    leaf.mass = 3.0;
    leaf.coefficients[0] = dvec3(1.0, 2.0, 3.0);
    photon::LeafLight other = leaf;  // in the same place, denser
    other.mass = 9.0;
    other.coefficients[0] = dvec3(5.0);
    const std::vector leaves{leaf, other};
    const bake::VoxelBox box = bake::boxOf(leaves, 1.0);
    const bake::VoxelHarmonics light = bake::spread(leaves, box, [] {});
    const std::int32_t inside = light.number[box.indexOf({-1, 2, 1})];
    ASSERT_GE(inside, 0);
    const dvec3 mean = light.coefficients[static_cast<std::size_t>(inside)][0];
    EXPECT_NEAR(mean.x, 4.0, 1e-12);
    EXPECT_NEAR(mean.z, 4.5, 1e-12);
    for (const auto& coefficients : light.coefficients) EXPECT_NEAR(coefficients[0].y, 4.25, 1e-12);
}

TEST(Bake, RefusesWhatIsTooMuch) {
    scene::Scene scene = bakedScene();
    scene.sky.radiance = dvec3(1.0);
    EXPECT_THROW(baked(scene, 0.1), InputError);
    EXPECT_THROW(baked(scene, 1e-7), InputError);
    scene.sky.radiance = dvec3(0.0);
    EXPECT_THROW(baked(scene, 10.0), InputError);  // dark
}

}  // namespace
}  // namespace lumulus
