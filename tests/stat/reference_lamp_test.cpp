#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/lamp_light.h"
#include "reference/tracer.h"
#include "support/statistics.h"

// Lamps of the reference against what is known in closed form.
namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double pi = glm::pi<double>();
constexpr dvec3 albedo(0.8, 0.5, 0.2), watts(300.0, 200.0, 100.0);

scene::Lamp lampAt(const dvec3& position, scene::LampKind kind, double angle, double softness) {
    scene::Lamp lamp;
    lamp.kind = kind;
    lamp.position = position;
    lamp.angle = angle;
    lamp.softness = softness;
    lamp.power = watts;
    return lamp;
}

/// Nothing but lamps, in the dark.
scene::Scene darkScene(const scene::Lamp& lamp) {
    scene::Scene scene;
    scene.clouds.clear();
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.0);
    scene.lamps = {lamp};
    return scene;
}

void addFog(scene::Scene& scene, double scattering, double absorption) {
    scene::FogMedium& fog = scene.fog.media.emplace_back();
    fog.kind = scene::MediumKind::ellipsoid;
    fog.halfSize = dvec3(100.0);
    fog.scattering = dvec3(scattering);
    fog.absorption = dvec3(absorption);
    fog.g = 0.0;
}

template <typename Tracer>
void expectSeen(const Tracer& tracer, const Ray& ray, int samples, const dvec3& expected, double digits = 0.0) {
    Random random(31, 0, 0);
    RunningMean mean[3];
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(ray, random);
        for (int c = 0; c < 3; ++c)
            mean[c].add(sample.radiance[c] + sample.lamps[c] + sample.passed[c] * tracer.environment().unit()[c]);
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(mean[c].standardError(), 0.02 * expected[c]);
        EXPECT_NEAR(mean[c].mean(), expected[c], 4.0 * mean[c].standardError() + (digits + 1e-12) * expected[c]);
    }
}

/// The mean over points that lie evenly on the sphere.
double totalShare(const scene::Lamp& lamp) {
    const LampLight light(lamp);
    constexpr int count = 400'000;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count, across = std::sqrt(1.0 - z * z);
        const double azimuth = 2.399963229728653 * i;  // the golden angle
        sum += light.share({across * std::cos(azimuth), across * std::sin(azimuth), z});
    }
    return sum * 4.0 * pi / count;
}

TEST(ReferenceLamp, EveryBeamHasItsPower) {
    for (const double softness : {0.0, 0.3, 1.0}) {
        for (const double angle : {20.0, 90.0, 180.0}) {
            for (const auto kind : {scene::LampKind::spot, scene::LampKind::pyramid}) {
                scene::Lamp lamp = lampAt(dvec3(0.0), kind, angle, softness);
                lamp.direction = glm::normalize(dvec3(0.3, -0.8, 0.4));
                EXPECT_NEAR(totalShare(lamp), 1.0, 3e-3) << angle << "°, softness " << softness;
            }
        }
    }
    EXPECT_NEAR(totalShare(lampAt(dvec3(0.0), scene::LampKind::point, 60.0, 0.0)), 1.0, 1e-9);
}

/// Radiant intensity straight ahead of a beam with hard sides [W/sr].
dvec3 intensityOf(const scene::Lamp& lamp) {
    const double half = glm::radians(0.5 * lamp.angle);
    if (lamp.kind == scene::LampKind::point) return lamp.power / (4.0 * pi);
    if (lamp.kind == scene::LampKind::spot) return lamp.power / (2.0 * pi * (1.0 - std::cos(half)));
    return lamp.power / (4.0 * std::asin(std::sin(half) * std::sin(half)));
}

/// A plane below the lamp: albedo/π · I/r², through an absorbing fog e^(−σr) of it.
TEST(ReferenceLamp, IrradianceFallsWithTheSquareOfTheDistanceAndInHaze) {
    for (const double angle : {10.0, 60.0, 180.0}) {
        for (const auto kind : {scene::LampKind::point, scene::LampKind::spot, scene::LampKind::pyramid}) {
            for (const double absorption : {0.0, 0.05}) {
                const scene::Lamp lamp = lampAt({0.0, 20.0, 0.0}, kind, angle, 0.0);
                scene::Scene scene = darkScene(lamp);
                scene.ground.emplace();
                scene.ground->albedo = albedo;
                if (absorption > 0.0) addFog(scene, 0.0, absorption);
                const dvec3 irradiance = intensityOf(lamp) / 400.0 * std::exp(-20.0 * absorption);
                const double seenThrough = std::exp(-5.0 * absorption);
                expectSeen(PathTracer(scene, {}, Majorant::global), {{0.0, 5.0, 0.0}, {0.0, -1.0, 0.0}}, 4000,
                           albedo / pi * irradiance * seenThrough, absorption > 0.0 ? 6e-3 : 1e-4);
            }
        }
    }
}

TEST(ReferenceLamp, BesideTheConeThereIsNoLight) {
    scene::Scene scene = darkScene(lampAt({0.0, 20.0, 0.0}, scene::LampKind::spot, 60.0, 0.5));
    scene.ground.emplace();
    const PathTracer tracer(scene, {}, Majorant::global);
    Random random(32, 0, 0);
    for (int i = 0; i < 1000; ++i)
        EXPECT_EQ(tracer.trace({{12.0, 5.0, 0.0}, {0.0, -1.0, 0.0}}, random).radiance, dvec3(0.0));
}

TEST(ReferenceLamp, TheDiscIsSeenThroughTheHaze) {
    const scene::Lamp lamp = lampAt({0.0, 0.0, -20.0}, scene::LampKind::point, 60.0, 0.0);
    scene::Scene scene = darkScene(lamp);
    addFog(scene, 0.0, 0.05);
    const dvec3 radiance = watts / (4.0 * pi) / (pi * lamp.radius * lamp.radius);
    expectSeen(PathTracer(scene, {}, Majorant::global), {dvec3(0.0), {0.0, 0.0, -1.0}}, 20'000,
               radiance * std::exp(-0.05 * (20.0 - lamp.radius)));
    scene.lamps[0].on = false;
    Random random(33, 0, 0);
    EXPECT_EQ(PathTracer(scene, {}, Majorant::global).trace({dvec3(0.0), {0.0, 0.0, -1.0}}, random).radiance,
              dvec3(0.0));
}

/// ∫ σs/4π I/d² e^(−σ(t + d)) dt along a ray that passes the lamp at 6 m, where it lights it.
dvec3 scatteredOnce(const LampLight& light, const dvec3& lamp, double scattering, double extinction) {
    constexpr int steps = 50'000;
    const double b = -lamp.z, h = std::hypot(lamp.x, lamp.y);
    const double from = std::atan2(-b, h), to = std::atan2(100.0 - b, h);
    dvec3 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const double angle = from + (i + 0.5) / steps * (to - from), t = b + h * std::tan(angle);
        const dvec3 way = dvec3(0.0, 0.0, -t) - lamp;
        const double distance = glm::length(way);
        // dt/d² = dθ/h
        sum += watts * light.share(way / distance) * (std::exp(-extinction * (t + distance)) / h);
    }
    return sum * (scattering / (4.0 * pi) * (to - from) / steps);
}

TEST(ReferenceLamp, FirstScatteringIsTheQuadrature) {
    constexpr double scattering = 0.02, absorption = 0.01;
    const dvec3 position(0.0, 6.0, -25.0);
    for (const auto kind : {scene::LampKind::point, scene::LampKind::spot, scene::LampKind::pyramid}) {
        scene::Lamp lamp = lampAt(position, kind, 70.0, 0.4);
        lamp.direction = glm::normalize(dvec3(0.1, -0.9, 0.3));
        lamp.radius = 0.01;
        scene::Scene scene = darkScene(lamp);
        addFog(scene, scattering, absorption);
        const PathTracer tracer(scene, {}, Majorant::global, 1);
        expectSeen(tracer, {dvec3(0.0), {0.0, 0.0, -1.0}}, 100'000,
                   scatteredOnce(LampLight(lamp), position, scattering, scattering + absorption), 1e-4);
    }
}

/// In the air of an atmosphere, four wavelengths: 20 m of clear air are next to nothing.
TEST(ReferenceLamp, LightsThePlanet) {
    const scene::Lamp lamp = lampAt({0.0, 20.0, 0.0}, scene::LampKind::spot, 60.0, 0.0);
    scene::Scene scene = darkScene(lamp);
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sky.groundAlbedo = dvec3(0.3);
    expectSeen(AirTracer(scene, {}, Majorant::global, 1), {{0.0, 5.0, 0.0}, {0.0, -1.0, 0.0}}, 4000,
               0.3 / pi * intensityOf(lamp) / 400.0, 0.01);
}

}  // namespace
}  // namespace lumulus::reference
