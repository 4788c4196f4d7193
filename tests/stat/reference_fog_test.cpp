#include "reference/fog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "reference/tracer.h"
#include "stat/ball.h"
#include "support/statistics.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double reach = 100.0;  ///< radius of the fog, metres

/// A ball of fog up to `reach` around the origin, without lights.
scene::Scene fogScene(const dvec3& scattering, const dvec3& absorption, double g) {
    scene::Scene scene;
    scene.clouds.clear();
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.0);
    scene.fog.media.resize(1);
    scene.fog.media[0].kind = scene::MediumKind::ellipsoid;
    scene.fog.media[0].halfSize = dvec3(reach);
    scene.fog.media[0].scattering = scattering;
    scene.fog.media[0].absorption = absorption;
    scene.fog.media[0].g = g;
    return scene;
}

scene::Surface wall(double distance, const dvec3& emission) {
    scene::Surface surface;
    surface.position = dvec3(0.0, 0.0, -distance);
    surface.normal = dvec3(0.0, 0.0, 1.0);
    surface.albedo = dvec3(0.0);
    surface.emission = emission;
    return surface;
}

scene::FogMedium exponentialMedium(const dvec3& absorption) {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::exponential;
    medium.falloff = 0.07;
    medium.direction = glm::normalize(dvec3(0.3, 0.2, 1.0));
    medium.absorption = absorption;
    return medium;
}

scene::FogMedium sphereMedium(const dvec3& center, double radius, const dvec3& absorption) {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::sphere;
    medium.center = center;
    medium.radius = radius;
    medium.absorption = absorption;
    return medium;
}

const Ray ahead{dvec3(0.0), {0.0, 0.0, -1.0}};

/// Means and standard errors of the radiance that rays from `rayOf(random)` see, the sky behind included.
struct Seen {
    RunningMean channel[3];

    void expectNear(const dvec3& expected, const char* what, double digits = 0.0) const {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(channel[c].mean(), expected[c], 4.0 * channel[c].standardError() + digits * expected[c] + 1e-12)
                << what << ", channel " << c;
        }
    }
};

template <typename RayOf>
Seen seenBy(const scene::Scene& scene, int samples, RayOf&& rayOf, const std::vector<vdb::PlacedVolume>& volumes = {}) {
    const PathTracer tracer(scene, volumes, Majorant::local);
    Random random(11, 0, 0);
    Seen seen;
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(rayOf(random), random);
        const dvec3 radiance = sample.radiance + sample.passed * tracer.environment().unit();
        for (int c = 0; c < 3; ++c) seen.channel[c].add(radiance[c]);
        EXPECT_FALSE(sample.lost);
    }
    return seen;
}

Seen seen(const scene::Scene& scene, int samples, const Ray& ray = ahead,
          const std::vector<vdb::PlacedVolume>& volumes = {}) {
    return seenBy(
        scene, samples, [&](Random&) { return ray; }, volumes);
}

/// An emissive wall behind fog that only absorbs, its depth by channel in closed form.
TEST(ReferenceFog, AnEmissiveWallFadesByBeerLambert) {
    constexpr double distance = 40.0;
    const dvec3 absorption(0.01, 0.05, 0.1), emission(3.0, 2.0, 1.0);
    const auto fades = [&](const scene::FogMedium& medium, double path, const char* what) {
        scene::Scene scene = fogScene(dvec3(0.0), dvec3(0.0), 0.0);
        scene.fog.media[0] = medium;
        scene.surfaces = {wall(distance, emission)};
        seen(scene, 40'000).expectNear(emission * glm::exp(-absorption * path), what);
        const PathTracer tracer(scene, {}, Majorant::global);
        EXPECT_EQ(tracer.integrate(ahead).transmittance, dvec3(0.0));
        EXPECT_EQ(tracer.integrate(ahead).clear, 0.0);
        EXPECT_DOUBLE_EQ(tracer.integrate(ahead).distance, distance) << "fog has no depth";
        EXPECT_DOUBLE_EQ(tracer.front(ahead).value(), distance);
    };
    fades(fogScene(dvec3(0.0), absorption, 0.0).fog.media[0], distance, "homogeneous");
    const double slope = 0.07 / std::sqrt(0.09 + 0.04 + 1.0);
    fades(exponentialMedium(absorption), (std::exp(slope * distance) - 1.0) / slope, "exponential");
    // the eye is 5 m from the axis of a sphere of 20 m, 25 m before its middle
    const double half = std::sqrt(20.0 * 20.0 - 25.0);
    const double tail = distance - 25.0;
    const double path = 2.0 / 3.0 * half * half * half / 400.0 + tail * (half * half - tail * tail / 3.0) / 400.0;
    fades(sphereMedium({5.0, 0.0, -25.0}, 20.0, absorption), path, "sphere");
}

/// Media add up, and the sky behind is seen through all of them.
TEST(ReferenceFog, MediaMultiplyTheirTransmittances) {
    const Ray up{dvec3(0.0), {0.0, 1.0, 0.0}};
    scene::Scene scene = fogScene(dvec3(0.0), dvec3(0.002, 0.004, 0.006), 0.0);
    scene.fog.media.push_back(sphereMedium({0.0, 30.0, 0.0}, 10.0, dvec3(0.03, 0.02, 0.0)));
    scene.fog.media.push_back(exponentialMedium(dvec3(1e-4)));
    scene.fog.media.back().direction = glm::normalize(dvec3(0.3, -1.0, 0.2));  // denser upwards
    scene.fog.media.back().bottom = 10.0;
    scene.fog.media.back().top = 60.0;
    scene.fog.media.push_back({});
    scene.fog.media.back().kind = scene::MediumKind::box;
    scene.fog.media.back().center = dvec3(0.0, 80.0, 10.0);
    scene.fog.media.back().halfSize = dvec3(5.0, 4.0, 11.0);
    scene.fog.media.back().absorption = dvec3(0.0, 0.01, 0.02);
    scene.sky.radiance = dvec3(1.0, 2.0, 3.0);
    const double slope = 0.07 / std::sqrt(0.09 + 0.04 + 1.0);
    const dvec3 depth = reach * scene.fog.media[0].absorption + 40.0 / 3.0 * scene.fog.media[1].absorption +
                        (std::exp(slope * 60.0) - std::exp(slope * 10.0)) / slope * scene.fog.media[2].absorption +
                        8.0 * scene.fog.media[3].absorption;
    seen(scene, 40'000, up).expectNear(scene.sky.radiance * glm::exp(-depth), "the sky");
    const PathTracer tracer(scene, {}, Majorant::global);
    EXPECT_NEAR(glm::distance(tracer.integrate(up).transmittance, glm::exp(-depth)), 0.0, 1e-9);
    EXPECT_EQ(tracer.integrate(up).clear, 1.0);
    EXPECT_FALSE(tracer.front(up));
}

/// Without absorption every path keeps its weight: all is as bright as the sky, whatever stands in it.
TEST(ReferenceFog, WhiteFurnaceIsExact) {
    scene::Scene scene = fogScene(dvec3(0.05), dvec3(0.0), 0.7);
    scene.sky.radiance = dvec3(0.3, 1.0, 7.0);
    scene.fog.media.push_back(sphereMedium({0.0, 0.0, -30.0}, 20.0, dvec3(0.0)));
    scene.fog.media.back().scattering = dvec3(0.3);
    scene.surfaces = {wall(10.0, dvec3(0.0))};
    scene.surfaces[0].kind = scene::SurfaceKind::sphere;
    scene.surfaces[0].radius = 3.0;
    scene.surfaces[0].albedo = dvec3(1.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.2;
    const vdb::Volume ball = ballVolume(16, 10.0);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    Random random(12, 0, 0);
    int passed = 0;
    for (int i = 0; i < 2000; ++i) {
        const PathSample sample = tracer.trace({{0.01 * i, 0.0, 30.0}, {0.0, 0.0, -1.0}}, random);
        const dvec3 radiance = sample.passed * scene.sky.radiance + sample.radiance;
        EXPECT_NEAR(glm::length(radiance / scene.sky.radiance - 1.0), 0.0, 1e-10);
        passed += sample.passed.x > 0.0 ? 1 : 0;
    }
    EXPECT_LT(passed, 100);
}

/// Channels that scatter alike without absorption are white, too, in the mean, whatever their extinction.
TEST(ReferenceFog, WhiteFurnaceOfColouredFog) {
    scene::Scene scene = fogScene(dvec3(0.01, 0.04, 0.1), dvec3(0.0), 0.5);
    scene.sky.radiance = dvec3(1.0);
    seen(scene, 60'000).expectNear(dvec3(1.0), "white");
}

/// Light of one scattering in a ball of homogeneous fog about the eye, by quadrature. The third channel's albedo is so
/// small that its light is that of one scattering to .1 %.
TEST(ReferenceFog, SingleScatteringOfTheSunAgreesWithQuadrature) {
    constexpr double extinction = 0.01, faint = 1e-3, g = 0.6;
    const dvec3 albedo(1.0, 0.5, faint);
    scene::Scene scene = fogScene(extinction * albedo, extinction * (1.0 - albedo), g);
    scene.sun.irradiance = dvec3(3.0);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 0.7, 0.4));
    const double cosine = glm::dot(ahead.direction, scene.sun.directionTo);
    const double p = (1.0 - g * g) / (4.0 * glm::pi<double>() * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
    double expected = 0.0;
    constexpr int steps = 20'000;
    for (int i = 0; i < steps; ++i) {
        const double t = reach * (i + 0.5) / steps;
        const double along = t * cosine;  // of the point, towards the sun
        const double exit = -along + std::sqrt(reach * reach - t * t + along * along);
        expected += extinction * p * 3.0 * std::exp(-extinction * (t + exit)) * reach / steps;
    }
    const Seen found = seen(scene, 100'000);
    const double mean = found.channel[2].mean() / faint, error = found.channel[2].standardError() / faint;
    EXPECT_LT(error, 0.01 * expected);
    EXPECT_NEAR(mean, expected, 4.0 * error + 0.002 * expected);
}

/// L = L_e (1 − e^{−C_t D})/C_t before a black wall; without extinction L_e·D.
TEST(ReferenceFog, EmissionHasItsClosedForm) {
    const dvec3 absorption(0.0, 0.02, 0.3), emission(0.1, 0.2, 0.3);
    scene::Scene scene = fogScene(dvec3(0.0), absorption, 0.0);
    scene.fog.media[0].emission = emission;
    scene.surfaces = {wall(40.0, dvec3(0.0))};
    const dvec3 expected(emission.x * 40.0, emission.y * (1.0 - std::exp(-0.8)) / 0.02,
                         emission.z * (1.0 - std::exp(-12.0)) / 0.3);
    seen(scene, 100'000).expectNear(expected, "homogeneous");
    scene.fog.media[0] = sphereMedium({0.0, 0.0, -20.0}, 10.0, dvec3(0.0));
    scene.fog.media[0].emission = emission;
    seen(scene, 10).expectNear(emission * 40.0 / 3.0, "sphere", 1e-12);
}

/// A scene whose channels differ in everything shows in each channel what a grey scene shows with that channel's
/// numbers.
TEST(ReferenceFog, ChannelsDoNotMix) {
    const dvec3 scattering(0.01, 0.05, 0.2), absorption(0.001, 0.03, 0.01), light(4.0, 2.0, 1.0);
    const auto sceneOf = [&](const dvec3& s, const dvec3& a, const dvec3& l) {
        scene::Scene scene = fogScene(s, a, 0.8);
        scene.surfaces = {wall(30.0, l), wall(-50.0, 0.2 * l)};
        scene.surfaces[1].albedo = dvec3(0.4);
        scene.sun.irradiance = l;
        scene.sky.radiance = 0.1 * l;
        scene.fog.media[0].emission = 1e-3 * l;
        return scene;
    };
    const Seen coloured = seen(sceneOf(scattering, absorption, light), 60'000);
    for (int c = 0; c < 3; ++c) {
        const Seen grey = seen(sceneOf(dvec3(scattering[c]), dvec3(absorption[c]), dvec3(light[c])), 30'000);
        const double error = std::hypot(coloured.channel[c].standardError(), grey.channel[0].standardError());
        EXPECT_LT(error, 0.02 * grey.channel[0].mean());
        EXPECT_NEAR(coloured.channel[c].mean(), grey.channel[0].mean(), 4.0 * error) << c;
    }
}

/// A white lamp of radius r gives π L 4π r² to what absorbs nothing, fog or cloud: as much leaves at any radius R
/// around it, where the mean over the cosine is L r²/R².
void expectLampsEnergy(scene::Scene scene, double lampRadius, double outside,
                       const std::vector<vdb::PlacedVolume>& volumes) {
    scene.surfaces = {wall(0.0, dvec3(1.0))};
    scene.surfaces[0].kind = scene::SurfaceKind::sphere;
    scene.surfaces[0].radius = lampRadius;
    scene.surfaces[0].albedo = dvec3(1.0);
    const auto enter = [&](Random& random) {
        const dvec3 outwards = turned({0.0, 0.0, 1.0}, 2.0 * random.uniform(), random);
        return Ray{outside * outwards, turned(-outwards, 1.0 - std::sqrt(random.uniform()), random)};
    };
    const dvec3 expected(lampRadius * lampRadius / (outside * outside));
    const Seen found = seenBy(scene, 100'000, enter, volumes);
    EXPECT_LT(found.channel[0].standardError(), 0.05 * expected.x);
    found.expectNear(expected, "lamp");
}

TEST(ReferenceFog, EnergyOfALampLeavesTheFog) {
    for (const double scattering : {0.002, 0.03}) {
        expectLampsEnergy(fogScene(dvec3(scattering), dvec3(0.0), 0.6), 20.0, reach, {});
    }
}

TEST(ReferenceFog, EnergyOfALampLeavesACloud) {
    const vdb::Volume ball = ballVolume(16, 10.0);
    scene::Scene scene = fogScene(dvec3(0.01), dvec3(0.0), 0.6);
    scene.fog.media[0].halfSize = dvec3(15.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.2;
    expectLampsEnergy(scene, 4.0, 20.0, {ball});
}

/// Cloud and fog in one another: both only absorb, and their transmittances multiply.
TEST(ReferenceFog, CloudAndFogMix) {
    scene::Scene scene = fogScene(dvec3(0.0), dvec3(0.004, 0.01, 0.02), 0.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.05;
    scene.clouds[0].albedo = dvec3(0.0);
    scene.sky.radiance = dvec3(1.0);
    const vdb::Volume ball = ballVolume(34, 10.0);
    const Ray ray{{0.0, 0.0, 50.0}, {0.0, 0.0, -1.0}};
    const PathTracer tracer(scene, {ball}, Majorant::global);
    const dvec3 fogAlone = glm::exp(-(reach + ray.origin.z) * scene.fog.media[0].absorption);
    const RayIntegrals line = tracer.integrate(ray);
    EXPECT_NEAR(line.clear, std::exp(-1.0), 0.005);  // the voxels' stairs
    EXPECT_NEAR(glm::distance(line.transmittance, line.clear * fogAlone), 0.0, 1e-12);
    seen(scene, 100'000, ray, {ball}).expectNear(line.clear * fogAlone, "sky");
    // light that a cloud scatters through fog, and fog through a cloud: halves of one medium are the whole
    scene.clouds[0].extinction = 0.1;
    scene.clouds[0].albedo = dvec3(1.0);
    scene.clouds[0].phase.g = 0.5;
    scene.sun.irradiance = dvec3(2.0);
    scene.fog.media.clear();
    const Seen whole = seen(scene, 60'000, ray, {ball});
    // a ball of fog as large as the cloud
    scene::Scene mixed = scene;
    mixed.clouds[0].extinction = 0.05;
    mixed.fog = fogScene(dvec3(0.05), dvec3(0.0), 0.5).fog;
    mixed.fog.media[0].halfSize = dvec3(10.0);
    const Seen halves = seen(mixed, 60'000, ray, {ball});
    const double error = std::hypot(whole.channel[0].standardError(), halves.channel[0].standardError());
    EXPECT_LT(error, 0.02 * whole.channel[0].mean());
    EXPECT_NEAR(halves.channel[0].mean(), whole.channel[0].mean(), 4.0 * error + 0.01 * whole.channel[0].mean());
}

/// Fog that nobody sees the end of is given up, and counted, in bounded time.
TEST(ReferenceFog, EndlessWhiteFogIsGivenUp) {
    scene::Scene scene = fogScene(dvec3(4.0), dvec3(0.0), 0.0);
    scene.fog.media[0].halfSize = dvec3(1e5);
    scene.sky.radiance = dvec3(1.0);
    const PathTracer tracer(scene, {}, Majorant::global);
    Random random(13, 0, 0);
    for (int i = 0; i < 3; ++i) {
        const PathSample sample = tracer.trace(ahead, random);
        EXPECT_TRUE(sample.lost);
        EXPECT_EQ(sample.radiance, dvec3(0.0));
    }
}

/// From vacuum-like to solid, straight and far away: every number stays finite, and none is negative.
TEST(ReferenceFog, ExtremesStayFinite) {
    scene::FogMedium layer;
    layer.kind = scene::MediumKind::exponential;
    layer.bottom = -1e5;
    scene::FogMedium ball = sphereMedium({1e6, 0.0, 0.0}, 100.0, dvec3(0.0));
    Random random(14, 0, 0);
    for (const double falloff : {1e-9, 1e-3, 10.0, 1e3}) {
        for (const double visibility : {1.0, 1e3, 1e6}) {
            for (const double g : {0.0, -0.5, 0.9999}) {
                scene::Scene scene = fogScene(dvec3(0.0), dvec3(0.0), 0.0);
                layer.falloff = falloff;
                layer.g = ball.g = g;
                layer.scattering = ball.scattering = 3.912 / visibility * dvec3(0.5, 0.1, 0.9);
                layer.absorption = ball.absorption = 3.912 / visibility * dvec3(0.5, 0.9, 0.0);
                layer.emission = ball.emission = dvec3(1e-3);
                scene.fog.media = {layer, ball};
                scene.sun.irradiance = dvec3(1e5);
                scene.sky.radiance = dvec3(1.0);
                const PathTracer tracer(scene, {}, Majorant::global);
                for (const dvec3& direction : {dvec3(0.0, 1.0, 0.0), dvec3(0.0, -1.0, 0.0), dvec3(1.0, 0.0, 0.0)}) {
                    const Ray ray{{0.0, 1e4, 0.0}, direction};
                    const PathSample sample = tracer.trace(ray, random);
                    const dvec3 through = tracer.integrate(ray).transmittance;
                    for (int c = 0; c < 3; ++c) {
                        EXPECT_TRUE(std::isfinite(sample.radiance[c]) && sample.radiance[c] >= 0.0);
                        EXPECT_TRUE(std::isfinite(sample.passed[c]) && sample.passed[c] >= 0.0);
                        EXPECT_TRUE(through[c] >= 0.0 && through[c] <= 1.0);
                    }
                }
            }
        }
    }
}

/// Fog without in-scattering shows nothing of sun and sky but what comes straight, by surfaces or by clouds.
TEST(ReferenceFog, InscatteringCanBeLeftOut) {
    scene::Scene scene = fogScene(dvec3(0.02), dvec3(0.0), 0.5);
    scene.sky.radiance = dvec3(1.0);
    scene.sun.irradiance = dvec3(5.0);
    scene.fog.inscattering = false;
    seen(scene, 40'000).expectNear(dvec3(std::exp(-0.02 * reach)), "the sky alone");
    // a wall that glows, and a black sky: nothing is left out
    scene.surfaces = {wall(30.0, dvec3(1.0))};
    scene.sky.radiance = scene.sun.irradiance = dvec3(0.0);
    const Seen without = seen(scene, 40'000);
    scene.fog.inscattering = true;
    const Seen with = seen(scene, 40'000);
    EXPECT_EQ(with.channel[1].mean(), without.channel[1].mean());
    EXPECT_GT(with.channel[1].mean(), std::exp(-0.02 * 30.0) + 0.05) << "the wall's light is scattered";
    scene.sun.irradiance = dvec3(5.0);
    scene.sun.directionTo = dvec3(0.0, 0.0, 1.0);
    EXPECT_GT(seen(scene, 40'000).channel[1].mean(), with.channel[1].mean());
}

}  // namespace
}  // namespace lumulus::reference
