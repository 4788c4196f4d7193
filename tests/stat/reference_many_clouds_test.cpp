#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "reference/tracer.h"
#include "stat/ball.h"
#include "stat/seen_light.h"
#include "support/statistics.h"
#include "support/test_volumes.h"

// Many clouds in the reference, which are found by a tree of their boxes: the light is that of one volume that holds
// them all.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using glm::ivec3;
using test::RunningMean;

scene::Scene sceneOf(std::size_t clouds, double extinction) {
    scene::Scene scene;
    scene.clouds.resize(clouds);
    for (scene::Cloud& cloud : scene.clouds) {
        cloud.extinction = extinction;
        cloud.phase.g = 0.5;
    }
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 0.15, 0.1));
    return scene;
}

void expectAlike(const Seen& found, const Seen& expected, const std::string& what) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double error = std::hypot(found.channel[c].standardError(), expected.channel[c].standardError());
        EXPECT_NEAR(found.channel[c].mean(), expected.channel[c].mean(), 4.0 * error) << what << ", channel " << c;
        EXPECT_LT(error, 0.02 * expected.channel[c].mean()) << what;
    }
}

/// Lumps in rows along X, each of them a volume of its own or all in one volume: shadows that fall from one on the
/// other, and light that goes from one to the other, are those within one cloud.
TEST(ReferenceManyClouds, ShadowAndExchangeAreThoseOfOneVolume) {
    const ivec3 size(10, 8, 9), pitch(7, 0, 0);  // the boxes overlap
    const vdb::Volume lump = test::lumpyVolume(size, glm::dmat3(2.0), 5);
    for (const int n : {2, 7}) {
        vdb::Volume all = test::emptyVolume(size + (n - 1) * pitch, glm::dmat3(2.0));
        std::vector<vdb::PlacedVolume> apart;
        for (int i = 0; i < n; ++i) {
            apart.push_back(shifted(lump, 2.0 * i * dvec3(pitch)));
            for (int z = 0; z < size.z; ++z)
                for (int y = 0; y < size.y; ++y)
                    for (int x = 0; x < size.x; ++x)
                        all.density[all.index(x + i * pitch.x, y, z)] += lump.density[lump.index(x, y, z)];
        }
        all.maximum = *std::ranges::max_element(all.density);
        // onto the lump farthest from the sun
        const Ray ray{{9.0, 8.0, 60.0}, glm::normalize(dvec3(0.02, 0.01, -1.0))};
        const Seen whole = seen(sceneOf(1, 0.3), {all}, ray, 60'000, 1);
        expectAlike(seen(sceneOf(apart.size(), 0.3), apart, ray, 60'000, 2), whole, std::to_string(n));
    }
}

TEST(ReferenceManyClouds, TwelfthsAtOnePlaceAreTheWhole) {
    const vdb::Volume ball = ballVolume(20, 10.0);
    const Ray ray{{3.0, 1.0, 50.0}, {0.0, 0.0, -1.0}};
    const std::vector<vdb::PlacedVolume> volumes(12, vdb::PlacedVolume(ball));
    const scene::Scene whole = sceneOf(1, 0.2), parts = sceneOf(12, 0.2 / 12.0);
    expectAlike(seen(parts, volumes, ray, 40'000, 3), seen(whole, {ball}, ray, 40'000, 4), "twelfths");
    const RayIntegrals line = PathTracer(whole, {ball}, Majorant::local).integrate(ray);
    const RayIntegrals lines = PathTracer(parts, volumes, Majorant::local).integrate(ray);
    EXPECT_NEAR(lines.clear, line.clear, 1e-12);
    EXPECT_NEAR(lines.distance, line.distance, 1e-9);
}

/// Places, sizes and extinctions at random: integrals, first points and ratio tracking are those of the clouds one by
/// one.
TEST(ReferenceManyClouds, TheTreeMissesNone) {
    const vdb::Volume ball = ballVolume(12, 10.0);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto within = [&](double reach) { return reach * (2.0 * uniform(random) - 1.0); };
    scene::Scene scene = sceneOf(200, 0.01);
    std::vector<vdb::PlacedVolume> volumes;
    std::vector<Clouds> alone;
    for (scene::Cloud& cloud : scene.clouds) {
        const double scale = 0.2 + uniform(random);
        cloud.extinction *= 0.5 + uniform(random);
        volumes.push_back(shifted(ball, {within(200.0), within(30.0), within(200.0)}));
        volumes.back().toWorld.linear *= scale;
        alone.emplace_back(std::vector{cloud}, std::vector{volumes.back()}, Majorant::local);
    }
    const Clouds clouds(scene.clouds, volumes, Majorant::local);
    Random numbers(7, 0, 0);
    int met = 0;
    for (int i = 0; i < 300; ++i) {
        Ray ray{{within(250.0), within(40.0), within(250.0)}, {within(1.0), within(0.1), within(1.0)}};
        ray.direction = i == 0 ? dvec3(0.0, 0.0, 1.0) : glm::normalize(ray.direction);
        double clear = 1.0, front = 1e300;
        for (const Clouds& one : alone) {
            clear *= one.integrate(ray, 1e300).transmittance;
            front = std::min(front, one.front(ray).value_or(1e300));
        }
        EXPECT_NEAR(clouds.integrate(ray, 1e300).transmittance, clear, 1e-12);
        EXPECT_EQ(clouds.front(ray).value_or(1e300), front);
        met += clear < 0.9 ? 1 : 0;
        if (i % 50 != 0) continue;
        RunningMean passed, free;
        for (int k = 0; k < 20'000; ++k) {
            passed.add(clouds.passed(clouds.raysOf(ray), ray.direction, numbers, 1.0, 0.3));
            free.add(clouds.collide(clouds.raysOf(ray), 1e300, numbers) ? 0.0 : 1.0);
        }
        EXPECT_NEAR(passed.mean(), clear, 4.0 * passed.standardError() + 1e-12);
        EXPECT_NEAR(free.mean(), clear, 4.0 * free.standardError() + 1e-12);
    }
    EXPECT_GT(met, 50);
}

}  // namespace
}  // namespace lumulus::reference
