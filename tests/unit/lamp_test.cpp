#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "lamp/air.h"
#include "lamp/beam.h"
#include "lamp/haze.h"
#include "lamp/lamp_tree.h"
#include "lamp/once_scattered.h"
#include "lamp/ray_bundle.h"
#include "sky/atmosphere.h"

// Light of lamps in fog against plain sums over many steps.
namespace lumulus::lamp {
namespace {

using glm::dvec3;
using std::numbers::pi;

scene::Lamp lampOf(scene::LampKind kind, double angle, double softness) {
    scene::Lamp lamp;
    lamp.kind = kind;
    lamp.position = {3.0, 8.0, -40.0};
    lamp.direction = glm::normalize(dvec3(-0.2, -0.9, 0.4));
    lamp.angle = angle;
    lamp.softness = softness;
    lamp.radius = 1e-4;
    lamp.power = {300.0, 200.0, 100.0};
    return lamp;
}

scene::Fog fogOf(double g) {
    scene::Fog fog;
    scene::FogMedium& layer = fog.media.emplace_back();
    layer.scattering = {0.02, 0.03, 0.04};
    layer.absorption = dvec3(0.005);
    layer.g = g;
    layer.bottom = -2.0;
    layer.top = 20.0;
    scene::FogMedium& ball = fog.media.emplace_back();
    ball.kind = scene::MediumKind::ellipsoid;
    ball.center = {0.0, 5.0, -60.0};
    ball.halfSize = dvec3(20.0, 10.0, 15.0);
    ball.scattering = dvec3(0.03);
    ball.g = 0.3;
    return fog;
}

TEST(Beam, HasItsPowerOverAllDirections) {
    for (const auto kind : {scene::LampKind::point, scene::LampKind::spot, scene::LampKind::pyramid}) {
        for (const double softness : {0.0, 0.5, 1.0}) {
            for (const double angle : {30.0, 180.0}) {
                const Beam beam(lampOf(kind, angle, softness));
                constexpr int count = 400'000;
                double sum = 0.0;
                for (int i = 0; i < count; ++i) {
                    const double z = 1.0 - (2.0 * i + 1.0) / count, across = std::sqrt(1.0 - z * z);
                    const double azimuth = 2.399963229728653 * i;  // the golden angle
                    sum += beam.share({across * std::cos(azimuth), z, across * std::sin(azimuth)});
                }
                EXPECT_NEAR(sum * 4.0 * pi / count, 1.0, 3e-3) << angle << ", " << softness;
            }
        }
    }
}

/// Directions that are drawn have the mean of the intensity.
TEST(Beam, SamplesFollowTheIntensity) {
    const Beam beam(lampOf(scene::LampKind::spot, 80.0, 0.7));
    constexpr int across = 160;
    double drawn = 0.0, taken = 0.0;
    for (int i = 0; i < across * across; ++i) {
        dvec3 direction;
        const dvec3 u((i % across + 0.5) / across, (i / across + 0.5) / across, std::fmod(0.5 + i * 0.618034, 1.0));
        if (!beam.sample(u, direction)) continue;
        ++taken;
        drawn += glm::dot(direction, lampOf(scene::LampKind::spot, 80.0, 0.7).direction);
    }
    double expected = 0.0;
    constexpr int steps = 100'000;
    const double half = 40.0 * pi / 180.0;
    for (int i = 0; i < steps; ++i) {
        const double angle = (i + 0.5) / steps * half;
        const dvec3 axis = lampOf(scene::LampKind::spot, 80.0, 0.7).direction;
        const dvec3 side = glm::normalize(glm::cross(axis, dvec3(1.0, 0.0, 0.0)));
        expected += 2.0 * pi * std::sin(angle) * std::cos(angle) *
                    beam.share(std::cos(angle) * axis + std::sin(angle) * side) * half / steps;
    }
    EXPECT_NEAR(drawn / taken, expected, 2e-3);
}

/// ∫ Σ σs p(γ) I e^(−τ) / d² dt by even steps in the angle at the lamp.
dvec3 plainSum(const Haze& haze, const Beam& beam, const Ray& ray, const Part& part) {
    constexpr int steps = 40'000;
    const double nearest = glm::dot(beam.position() - ray.origin, ray.direction), miss = missOf(ray, beam.position());
    const double first = std::atan2(part.begin - nearest, miss), last = std::atan2(part.end - nearest, miss);
    dvec3 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        const double distance = nearest + miss * std::tan(first + (i + 0.5) / steps * (last - first));
        const dvec3 point = ray.origin + distance * ray.direction, way = point - beam.position();
        const double away = glm::length(way);
        const dvec3 travel = way / away;
        sum += haze.turned(point, -glm::dot(travel, ray.direction)) * beam.intensity(travel) *
               glm::exp(-haze.depth(ray, distance) - haze.depth({point, -travel}, away)) / miss;
    }
    return sum * ((last - first) / steps);
}

TEST(OnceScattered, IsThePlainSum) {
    const Ray rays[] = {{dvec3(0.0, 5.0, 0.0), glm::normalize(dvec3(0.02, 0.05, -1.0))},
                        {dvec3(0.0, 5.0, 0.0), glm::normalize(dvec3(0.07, 0.07, -1.0))},
                        {dvec3(0.0, 5.0, 0.0), glm::normalize(dvec3(-0.9, 0.1, -1.0))},
                        {dvec3(0.0, 5.0, 0.0), glm::normalize(dvec3(0.1, -0.05, 1.0))}};
    for (const double g : {0.0, 0.9, -0.5}) {
        const Haze haze(fogOf(g), dvec3(0.0, 5.0, 0.0));
        for (const auto kind : {scene::LampKind::point, scene::LampKind::spot, scene::LampKind::pyramid}) {
            const Beam beam(lampOf(kind, 70.0, 0.4));
            for (const Ray& ray : rays) {
                const Part part{0.0, 300.0};
                const dvec3 expected = plainSum(haze, beam, ray, part);
                const dvec3 found = onceScattered(haze, beam, ray, part, missOf(ray, beam.position()));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(found[c], expected[c], 2e-3 * expected[c] + 1e-12)
                        << "g " << g << ", kind " << static_cast<int>(kind) << ", " << ray.direction.x;
            }
        }
    }
}

/// A bundle of rays whose points, drawn at random, a lamp lights somewhere is never said to be dark; most of the others
/// are.
TEST(LampRays, NoneThatIsLitIsLeftOut) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto point = [&](double size) { return size * dvec3(any(random), any(random), any(random)); };
    int dark = 0, found = 0;
    for (int i = 0; i < 2000; ++i) {
        scene::Lamp lamp =
            lampOf(i % 2 == 0 ? scene::LampKind::spot : scene::LampKind::pyramid, 40.0 + 30.0 * (i % 4), 0.0);
        lamp.position = point(50.0);
        lamp.direction = glm::normalize(point(1.0));
        const Beam beam(lamp);
        const RayBundle rays{{point(50.0), glm::normalize(point(1.0))}, 0.5, 0.05, 100.0};
        bool lit = false;
        for (int k = 0; k < 300 && !lit; ++k) {
            const double at = 50.0 * (1.0 + any(random));
            const dvec3 place = rays.middle.origin + at * rays.middle.direction + 0.57 * rays.widthAt(at) * point(1.0);
            lit = beam.share(glm::normalize(place - beam.position())) > 0.0;
        }
        EXPECT_TRUE(!lit || mayLight(beam, 0.0, rays)) << i;
        dark += !lit;
        found += !lit && !mayLight(beam, 0.0, rays);
    }
    EXPECT_GT(found, 0.8 * dark);
}

/// A place far away takes one lamp for all, a place among the lamps takes each, and their power is that of all.
TEST(LampTree, GroupsHaveThePowerOfAll) {
    std::vector<Beam> beams;
    for (int i = 0; i < 100; ++i) {
        scene::Lamp lamp = lampOf(scene::LampKind::point, 60.0, 0.0);
        lamp.position = {i % 10, 0.0, i / 10};
        beams.emplace_back(lamp);
    }
    const LampTree tree(beams);
    const auto groups = tree.groups([](const LampNode&) { return true; });
    const auto cutAt = [&](const dvec3& place) {
        std::vector<NodeLight> cut;
        LampTree::cut(
            groups, 1e-3, 0.0,
            [&](const LampNode& node) {
                const double away = glm::distance(place, node.beam->position());
                const double bound = luminanceOf(node.beam->power()) / (1.0 + away * away);
                return NodeLight{&node, node.beam->power() / (1.0 + away * away), bound, node.variance / (away * away)};
            },
            cut);
        dvec3 power(0.0);
        for (const NodeLight& one : cut) power += one.node->beam->power();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(power[c], 100.0 * beams[0].power()[c], 1e-6);
        return cut.size();
    };
    EXPECT_EQ(cutAt({1000.0, 0.0, 0.0}), 1U);
    EXPECT_GT(cutAt({5.0, 1.0, 5.0}), 20U);
    EXPECT_LT(cutAt({30.0, 0.0, 5.0}), 40U);
}

/// Transmittance of the air for light of the sun's colour, against the atmosphere's own, at four wavelengths along a
/// curved planet; and its scattering coefficient at the ground against the sums of its parts.
TEST(LampAir, IsThatOfTheAtmosphere) {
    scene::Sky sky;
    sky.aerosolDepth = 0.2;
    const sky::Air air = sky::airOf(sky);
    const sky::Atmosphere atmosphere(air, 100.0, 0.53);
    const dvec3 eye(10.0, 130.0, -20.0);
    const Haze haze(withAir({}, air, 100.0), eye);
    const dvec3 white = air.rgb(sky::Spectrum(1.0));
    for (const dvec3& way : {dvec3(0.8, 0.0, -0.6), dvec3(0.0, 0.6, 0.8), dvec3(0.0, 1.0, 0.0)}) {
        for (const double metres : {300.0, 3000.0, 15'000.0}) {
            const sky::AirLight along = atmosphere.along(atmosphere.at(eye, way, {0.0, 1.0, 0.0}), metres, 200);
            const dvec3 expected = air.rgb(along.transmittance) / white,
                        found = glm::exp(-haze.depth({eye, way}, metres));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c] / expected[c], 1.0, 0.002 + 0.05 * (1.0 - expected[c])) << metres << " " << c;
        }
    }
    const dvec3 ground(0.0, 100.0, 0.0), scattered = air.rgb(air.molecules + air.aerosolScattering) / white;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(haze.scattering(ground)[c], scattered[c], 1e-3 * scattered[c]);
    EXPECT_EQ(haze.scattering({0.0, 99.0, 0.0}), dvec3(0.0)) << "below the ground";
}

}  // namespace
}  // namespace lumulus::lamp
