#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/tracer.h"
#include "stat/ball.h"
#include "support/statistics.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr dvec3 albedo(0.8, 0.5, 0.2);

scene::Scene emptyScene() {
    scene::Scene scene;
    scene.clouds.clear();
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.0);
    scene.surfaces.resize(1);
    scene.surfaces[0].albedo = albedo;
    return scene;
}

dvec3 meanRadiance(const scene::Scene& scene, const Ray& ray, int samples, dvec3& error,
                   const std::vector<vdb::PlacedVolume>& volumes = {}) {
    const PathTracer tracer(scene, volumes, Majorant::local);
    Random random(21, 0, 0);
    RunningMean mean[3];
    for (int i = 0; i < samples; ++i) {
        const PathSample sample = tracer.trace(ray, random);
        for (int c = 0; c < 3; ++c) mean[c].add(sample.radiance[c] + sample.passed[c] * tracer.environment().unit()[c]);
    }
    error = {mean[0].standardError(), mean[1].standardError(), mean[2].standardError()};
    return {mean[0].mean(), mean[1].mean(), mean[2].mean()};
}

void expectNear(const dvec3& found, const dvec3& expected, const dvec3& error) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 4.0 * error[c] + 1e-12) << "channel " << c;
}

const Ray down{{3.0, 30.0, -4.0}, {0.0, -1.0, 0.0}};

/// L = albedo/π · E · cos on a plane, whatever the size of the sun's disc.
TEST(ReferenceSurface, ASunlitPlaneIsLambert) {
    scene::Scene scene = emptyScene();
    scene.sun.irradiance = dvec3(3.0, 2.0, 1.0);
    for (const double elevation : {90.0, 30.0}) {
        for (const double diameter : {0.0, 40.0}) {
            scene.sun.directionTo = scene::skyDirection(10.0, elevation);
            scene.sun.angularDiameter = diameter;
            const dvec3 expected =
                albedo / glm::pi<double>() * scene.sun.irradiance * std::sin(glm::radians(elevation));
            dvec3 error;
            const dvec3 found = meanRadiance(scene, down, 40'000, error);
            EXPECT_LT(error.x, 0.02 * expected.x);
            expectNear(found, expected, error);
        }
    }
    scene.sun.directionTo = dvec3(0.0, -1.0, 0.0);
    dvec3 error;
    EXPECT_EQ(meanRadiance(scene, down, 100, error), dvec3(0.0)) << "lit from below";
}

TEST(ReferenceSurface, ASunlitBallIsLambertWithAShadowBehind) {
    scene::Scene scene = emptyScene();
    scene.surfaces[0].kind = scene::SurfaceKind::sphere;
    scene.surfaces[0].radius = 10.0;
    scene.sun.irradiance = dvec3(1.0);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 1.0, 0.0));
    const double x = 6.0;  // the normal there is (.6, .8, 0)
    dvec3 error;
    const dvec3 found = meanRadiance(scene, {{x, 50.0, 0.0}, {0.0, -1.0, 0.0}}, 20'000, error);
    expectNear(found, albedo / glm::pi<double>() * (1.4 / std::sqrt(2.0)), error);
    EXPECT_EQ(meanRadiance(scene, {{-9.0, 50.0, 0.0}, {0.0, -1.0, 0.0}}, 100, error), dvec3(0.0)) << "turned away";
    // a plane under the ball, in its shadow
    scene.surfaces.emplace_back();
    scene.surfaces[1].position = dvec3(0.0, -20.0, 0.0);
    const Ray toShadow{{-20.0, -10.0, 0.0}, {0.0, -1.0, 0.0}};
    const PathTracer tracer(scene, {}, Majorant::global);
    Random random(22, 0, 0);
    RunningMean shadow;
    for (int i = 0; i < 4000; ++i) shadow.add(tracer.trace(toShadow, random).radiance.x);
    EXPECT_LT(shadow.mean(), 0.1 * 0.5 / glm::pi<double>() * std::sqrt(0.5)) << "but for what the ball reflects";
}

/// Under a constant sky a plane is albedo times the sky; a plane that glows adds its own light.
TEST(ReferenceSurface, APlaneUnderTheSky) {
    scene::Scene scene = emptyScene();
    scene.sky.radiance = dvec3(1.0, 2.0, 3.0);
    scene.surfaces[0].emission = dvec3(0.5, 0.0, 0.1);
    dvec3 error;
    const dvec3 found = meanRadiance(scene, down, 40'000, error);
    expectNear(found, albedo * scene.sky.radiance + scene.surfaces[0].emission, error);
}

/// Between two parallel planes, of which one glows: L = e/(1 − a²) seen on it, and a·e/(1 − a²) on the other.
TEST(ReferenceSurface, LightGoesToAndFro) {
    scene::Scene scene = emptyScene();
    scene.surfaces.emplace_back();
    scene.surfaces[1].position = dvec3(0.0, 100.0, 0.0);
    scene.surfaces[1].albedo = albedo;
    scene.surfaces[0].emission = dvec3(1.0);
    dvec3 error;
    dvec3 found = meanRadiance(scene, down, 40'000, error);
    expectNear(found, 1.0 / (1.0 - albedo * albedo), error);
    found = meanRadiance(scene, {down.origin, -down.direction}, 40'000, error);
    expectNear(found, albedo / (1.0 - albedo * albedo), error);
}

/// A ball of radiance L at distance d gives E = π L R²/d² cos on a plane below its horizon (the view factor of a ball),
/// and is one among other lamps.
TEST(ReferenceSurface, ALampLightsAPlane) {
    scene::Scene scene = emptyScene();
    const dvec3 middles[] = {{3.0, 10.0, -4.0}, {10.0, 5.0, 0.0}, {-200.0, 300.0, 100.0}};
    const dvec3 lights[] = {dvec3(1.0, 2.0, 3.0), dvec3(5.0, 0.0, 1.0), dvec3(1e5)};
    const double radii[] = {4.0, 0.5, 1.0};
    dvec3 expected(0.0);
    for (int i = 0; i < 3; ++i) {
        scene::Surface& lamp = scene.surfaces.emplace_back();
        lamp.kind = scene::SurfaceKind::sphere;
        lamp.position = middles[i];
        lamp.radius = radii[i];
        lamp.emission = lights[i];
        lamp.albedo = dvec3(0.0);
        const dvec3 way = middles[i] - dvec3(3.0, 0.0, -4.0);
        const double distance = glm::length(way);
        expected += albedo * lights[i] * (radii[i] * radii[i] / (distance * distance)) * (way.y / distance);
    }
    dvec3 error;
    const Ray ray{{3.0, 5.0, -4.0}, {0.0, -1.0, 0.0}};
    const dvec3 found = meanRadiance(scene, ray, 60'000, error);
    EXPECT_LT(error.y, 0.01 * expected.y);
    expectNear(found, expected, error);
}

/// A cloud before a glowing plane, and its shadow on a plane that does not glow.
TEST(ReferenceSurface, CloudsDimSurfacesAndAreHiddenByThem) {
    scene::Scene scene = emptyScene();
    scene.surfaces[0].position = dvec3(0.0, -20.0, 0.0);
    scene.surfaces[0].emission = dvec3(2.0);
    scene.surfaces[0].albedo = dvec3(0.0);
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.1;
    scene.clouds[0].albedo = dvec3(0.0);
    const vdb::Volume ball = ballVolume(34, 10.0);
    const Ray through{{0.0, 50.0, 0.0}, {0.0, -1.0, 0.0}};
    const PathTracer tracer(scene, {ball}, Majorant::local);
    scene::Scene bare = scene;
    bare.surfaces.clear();
    const double clear = PathTracer(bare, {ball}, Majorant::local).integrate(through).clear;
    const double cloudDistance = PathTracer(bare, {ball}, Majorant::local).integrate(through).distance;
    dvec3 error;
    dvec3 found = meanRadiance(scene, through, 60'000, error, {ball});
    expectNear(found, 2.0 * dvec3(clear), error);
    EXPECT_EQ(tracer.integrate(through).clear, 0.0);
    EXPECT_NEAR(tracer.integrate(through).distance, cloudDistance + clear * 70.0, 1e-9);
    // lit from above: the shadow at the foot of the ray
    scene.surfaces[0].emission = dvec3(0.0);
    scene.surfaces[0].albedo = albedo;
    scene.sun.irradiance = dvec3(1.0);
    scene.sun.angularDiameter = 0.0;
    scene.sun.directionTo = dvec3(0.0, 1.0, 0.0);
    const Ray beneath{{0.0, -15.0, 0.0}, {0.0, -1.0, 0.0}};
    found = meanRadiance(scene, beneath, 60'000, error, {ball});
    expectNear(found, albedo / glm::pi<double>() * clear, error);
    // a plane above the cloud hides it
    scene.surfaces[0].position = dvec3(0.0, 30.0, 0.0);
    const PathTracer hidden(scene, {ball}, Majorant::local);
    EXPECT_DOUBLE_EQ(hidden.integrate(through).distance, 20.0);
    EXPECT_DOUBLE_EQ(hidden.front(through).value(), 20.0);
    EXPECT_EQ(hidden.integrate(through).clear, 0.0);
    // one that cuts it in halves leaves the upper one
    scene.surfaces[0].position = dvec3(0.0);
    const PathTracer halved(scene, {ball}, Majorant::local);
    EXPECT_LT(halved.front(through).value(), 41.0);
    // ∫ t σ e^{−σ(t − 40)} dt over the half from 40 to 50 m, and the plane with what is left, e⁻¹; the voxels' stairs
    const double left = std::exp(-1.0);
    EXPECT_NEAR(halved.integrate(through).distance, 40.0 * (1.0 - left) + 10.0 * (1.0 - 2.0 * left) + 50.0 * left, 0.2);
}

}  // namespace
}  // namespace lumulus::reference
