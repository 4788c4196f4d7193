#include "reference/render.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "reference/film_file.h"
#include "stat/ball.h"
#include "support/statistics.h"
#include "support/temporary_folder.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;

const auto goOn = [](std::uint64_t) { return true; };

/// A small picture of a ball under the sun and the sky.
scene::Scene ballScene() {
    scene::Scene scene;
    scene.image = {20, 20, 0.0};
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.3;
    scene.clouds[0].phase.g = 0.3;
    scene.clouds[0].albedo = dvec3(1.0, 0.98, 0.9);
    return scene;
}

vdb::Volume ball() {
    return ballVolume(16, 10.0);
}

LayeredImage rendered(const scene::Scene& scene, std::uint64_t seed, int passes) {
    const vdb::Volume volume = ball();
    Renderer renderer(scene, {volume}, Majorant::local, seed);
    for (int i = 0; i < passes; ++i) renderer.pass(goOn);
    return renderer.picture();
}

/// 32 short renders against one long one, with another seed: a z-test per pixel and channel.
TEST(Reference, ShortRendersAgreeWithALongOne) {
    constexpr int renders = 32, passes = 16;
    const scene::Scene scene = ballScene();
    std::vector<LayeredImage> parts;
    for (int k = 0; k < renders; ++k) parts.push_back(rendered(scene, static_cast<std::uint64_t>(100 + k), passes));
    const LayeredImage whole = rendered(scene, 99, 4 * renders * passes);
    double largest = 0.0, squares = 0.0, predicted = 0.0, spread = 0.0, count = 0.0;
    for (const std::string channel : {"R", "G", "B"}) {
        for (std::size_t i = 0; i < whole.pixels(); ++i) {
            test::RunningMean mean;
            for (const LayeredImage& part : parts) {
                mean.add(static_cast<double>(part.layers.at(channel)[i]));
                predicted += static_cast<double>(part.layers.at("variance." + channel)[i]) / renders;
            }
            const double error = mean.standardError();
            const double wholeVariance = static_cast<double>(whole.layers.at("variance." + channel)[i]);
            spread += renders * error * error;
            if (wholeVariance == 0.0) continue;
            const double z = (mean.mean() - static_cast<double>(whole.layers.at(channel)[i])) /
                             std::sqrt(error * error + wholeVariance);
            largest = std::max(largest, std::abs(z));
            squares += z * z;
            count += 1.0;
        }
    }
    // Student's t with 31 degrees of freedom: above 6.1 once in 1e6, and there are some 700 values
    EXPECT_GT(count, 600.0);
    EXPECT_LT(largest, 6.1);
    // the mean square of such a t is 1.07; channels of a pixel go together, so some 220 independent values
    EXPECT_NEAR(squares / count, 1.07, 4.0 * 1.07 * std::sqrt(2.0 / 220.0));
    // the variance layer is what 32 renders show
    EXPECT_NEAR(predicted / spread, 1.0, 4.0 * std::sqrt(2.0 / (31.0 * 220.0)) + 0.05);
}

TEST(Reference, DoesNotDependOnThreads) {
    const scene::Scene scene = ballScene();
    LayeredImage one, two;
    {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, 1);
        one = rendered(scene, 1, 5);
    }
    {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, 2);
        two = rendered(scene, 1, 5);
    }
    EXPECT_EQ(one.layers, two.layers);
    EXPECT_NE(one.layers, rendered(scene, 2, 5).layers);
}

TEST(Reference, GoesOnWithTheSameBits) {
    const scene::Scene scene = ballScene();
    const vdb::Volume volume = ball();
    const test::TemporaryFolder folder;
    const auto path = sumsBeside(folder / "ball.exr");
    EXPECT_EQ(path.filename(), "ball.exr.sums");
    {
        Renderer first(scene, {volume}, Majorant::global, 7);
        for (int i = 0; i < 18; ++i) first.pass(goOn);
        writeFilm(path, first.film(), first.fingerprint());
    }
    Renderer second(scene, {volume}, Majorant::global, 7);
    second.resume(readFilm(path, second.fingerprint()));
    Renderer whole(scene, {volume}, Majorant::global, 7);
    for (int i = 0; i < 5; ++i) second.pass(goOn);
    for (int i = 0; i < 23; ++i) whole.pass(goOn);
    EXPECT_EQ(second.film(), whole.film());
    EXPECT_EQ(second.picture().layers, whole.picture().layers);
}

TEST(Reference, RefusesToGoOnFromSomethingElse) {
    scene::Scene scene = ballScene();
    const vdb::Volume volume = ball();
    const test::TemporaryFolder folder;
    const auto path = folder / "a.sums";
    Renderer renderer(scene, {volume}, Majorant::global, 7);
    renderer.pass(goOn);
    const std::uint64_t print = renderer.fingerprint();
    EXPECT_THROW(readFilm(path, print), InputError);
    writeFilm(path, renderer.film(), print);
    EXPECT_EQ(readFilm(path, print), renderer.film());

    EXPECT_NE(Renderer(scene, {volume}, Majorant::global, 8).fingerprint(), print);
    EXPECT_NE(Renderer(scene, {volume}, Majorant::local, 7).fingerprint(), print);
    scene.clouds[0].albedo.z = 0.91;
    EXPECT_THROW(readFilm(path, Renderer(scene, {volume}, Majorant::global, 7).fingerprint()), InputError);

    const std::string whole = test::readAll(path);
    for (const std::size_t length : {std::size_t{0}, std::size_t{10}, std::size_t{100}, whole.size() - 1}) {
        test::writeAll(path, whole.substr(0, length));
        EXPECT_THROW(readFilm(path, print), InputError) << length;
    }
    std::string bent = whole;
    bent[bent.size() / 2] = static_cast<char>(bent[bent.size() / 2] ^ 4);
    test::writeAll(path, bent);
    EXPECT_THROW(readFilm(path, print), InputError);
}

TEST(Reference, AStoppedPassLeavesTheFilm) {
    scene::Scene scene = ballScene();
    scene.image = {600, 200, 0.0};  // several bands
    const vdb::Volume volume = ball();
    Renderer renderer(scene, {volume}, Majorant::local, 1);
    renderer.pass(goOn);
    const Film before = renderer.film();
    int calls = 0;
    EXPECT_FALSE(renderer.pass([&](std::uint64_t) { return ++calls < 2; }));
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(renderer.film(), before);
}

/// The same paths with and without the background: what is left out is the sky behind, and its variance.
TEST(Reference, LeavesTheBackgroundOut) {
    scene::Scene scene = ballScene();
    const LayeredImage with = rendered(scene, 3, 4);
    scene.image.background = false;
    const LayeredImage without = rendered(scene, 3, 4);
    EXPECT_EQ(with.layers.at("A"), std::vector<float>(with.pixels(), 1.0F));
    EXPECT_EQ(without.layers.at("A"), with.layers.at("cloud.A"));
    for (const std::string channel : {"R", "G", "B"})
        EXPECT_EQ(without.layers.at(channel), with.layers.at("cloud." + channel));
    EXPECT_EQ(without.layers.at("R")[0], 0.0F);
    // an absorbing ball scatters nothing: only the sky behind it varied
    scene.clouds[0].albedo = dvec3(0.0);
    EXPECT_EQ(rendered(scene, 3, 4).layers.at("variance.G"), std::vector<float>(with.pixels(), 0.0F));
    const vdb::Volume volume = ball();
    const Renderer one(scene, {volume}, Majorant::local, 3);
    scene.image.background = true;
    EXPECT_NE(one.fingerprint(), Renderer(scene, {volume}, Majorant::local, 3).fingerprint());
}

TEST(Reference, LayersAreWhatTheySay) {
    scene::Scene scene = ballScene();
    scene.sun.irradiance = dvec3(0.0);
    scene.clouds[0].albedo = dvec3(1.0);
    const LayeredImage image = rendered(scene, 3, 20);
    const auto value = [&](const char* layer, int x, int y) {
        return static_cast<double>(image.layers.at(layer)[static_cast<std::size_t>(y * image.width + x)]);
    };
    // a corner sees nothing but sky
    EXPECT_EQ(value("cloud.A", 0, 0), 0.0);
    EXPECT_EQ(value("transmittance.G", 0, 0), 1.0);
    EXPECT_EQ(value("depth.Z", 0, 0), 1e10);
    EXPECT_EQ(value("depth.front", 0, 0), 1e10F);
    EXPECT_EQ(value("cloud.B", 0, 0), 0.0);
    EXPECT_FLOAT_EQ(static_cast<float>(value("B", 0, 0)), static_cast<float>(scene.sky.radiance.z));
    EXPECT_EQ(value("variance.B", 0, 0), 0.0);
    // the middle: the ball in a white furnace
    const double sky = scene.sky.radiance.z;
    EXPECT_NEAR(value("B", 10, 10), sky, 1e-5 * sky);
    EXPECT_NEAR(value("transmittance.R", 10, 10), std::exp(-6.0), 0.01);
    EXPECT_NEAR(value("cloud.A", 10, 10) + value("transmittance.R", 10, 10), 1.0, 1e-6);
    EXPECT_GT(value("cloud.B", 10, 10), 0.8 * sky);
    // depth: about one mean free path behind the surface
    const vdb::Volume volume = ball();
    const Camera camera = makeCamera(scene.camera, scene.image, boundsOf(volume));
    EXPECT_NEAR(value("depth.Z", 10, 10), glm::length(camera.position) - 10.0 + 1.0 / 0.3, 1.0);
    // the front: the surface, which the interpolation of voxels of 10/7 m moves outwards by up to two of them
    const double surface = glm::length(camera.position) - 10.0;
    EXPECT_LT(value("depth.front", 10, 10), surface + 0.1);
    EXPECT_GT(value("depth.front", 10, 10), surface - 20.0 / 7.0);
    EXPECT_EQ(image.layers.count("sun.disc"), 0U);
}

/// Looking into the sun through the ball: its disc shines through by the true transmittance, and only there.
TEST(Reference, SunDiscShinesThrough) {
    scene::Scene scene = ballScene();
    scene.image = {9, 9, 0.0};
    scene.camera.position = dvec3(0.0, 0.0, 40.0);
    scene.camera.target = dvec3(0.0);
    scene.camera.verticalFov = 9.0;
    scene.sun.directionTo = dvec3(0.0, 0.0, -1.0);
    scene.sun.angularDiameter = 4.0;
    scene.clouds[0].extinction = 0.1;
    const LayeredImage image = rendered(scene, 3, 64);
    const std::size_t middle = 4 * 9 + 4;
    const double sine = std::sin(glm::radians(2.0));
    const double disc = scene.sun.irradiance.x / (M_PI * sine * sine);
    const double beyond = static_cast<double>(image.layers.at("R")[middle] - image.layers.at("cloud.R")[middle]);
    // the sky behind comes with e⁻²·L ± its noise, far below the disc
    EXPECT_NEAR(beyond / disc, std::exp(-2.0), 0.02);
    EXPECT_EQ(image.layers.at("sun.disc")[middle], 1.0F);
    EXPECT_EQ(image.layers.at("sun.disc")[0], 0.0F);
    EXPECT_LT(static_cast<double>(image.layers.at("R")[0]), 0.1 * disc);
}

/// The front is seen through the middle of the pixel, and does not depend on the samples.
TEST(Reference, FrontIsThatOfThePixelsMiddle) {
    scene::Scene scene = ballScene();
    scene.camera.projection = scene::Projection::orthographic;
    const vdb::Volume volume = ball();
    const Camera camera = makeCamera(scene.camera, scene.image, boundsOf(volume));
    const Medium medium(volume, 0.3);
    const std::vector<float> front = rendered(scene, 1, 1).layers.at("depth.front");
    EXPECT_EQ(front, rendered(scene, 2, 3).layers.at("depth.front"));
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 20; ++x) {
            const auto expected = frontAlong(medium, medium.toVoxel(camera.ray(x + 0.5, y + 0.5)));
            ASSERT_EQ(front[static_cast<std::size_t>(20 * y + x)], static_cast<float>(expected.value_or(1e10)));
        }
    }
    scene.camera.position = dvec3(0.0, 1.0, 0.0);
    scene.camera.target = dvec3(0.0, 1.0, -5.0);
    scene.camera.projection = scene::Projection::panorama;
    const LayeredImage inside = rendered(scene, 1, 1);
    for (const float value : inside.layers.at("depth.front")) EXPECT_EQ(value, 0.0F) << "from inside";
}

/// A floor under fog, up to the horizon, and the sky above.
TEST(Reference, LayersOfFogAndSurfaces) {
    scene::Scene scene = ballScene();
    scene.clouds.clear();
    scene.camera.position = dvec3(0.0, 10.0, 0.0);
    scene.camera.target = dvec3(0.0, 10.0, -1.0);
    scene.surfaces.resize(1);
    scene.fog.media.resize(1);
    scene.fog.media[0].kind = scene::MediumKind::ellipsoid;
    scene.fog.media[0].center = scene.camera.position.value();
    scene.fog.media[0].halfSize = dvec3(50.0);
    scene.fog.media[0].scattering = dvec3(0.01, 0.02, 0.03);
    Renderer renderer(scene, {}, Majorant::global, 1);
    for (int i = 0; i < 4; ++i) renderer.pass(goOn);
    const LayeredImage image = renderer.picture();
    const auto value = [&](const char* layer, int x, int y) {
        return static_cast<double>(image.layers.at(layer)[static_cast<std::size_t>(y * image.width + x)]);
    };
    EXPECT_EQ(value("depth.Z", 3, 2), 1e10) << "fog has no depth";
    EXPECT_EQ(value("depth.front", 3, 2), 1e10F);
    EXPECT_NEAR(value("transmittance.R", 3, 2), std::exp(-0.5), 1e-6);
    EXPECT_NEAR(value("transmittance.B", 3, 2), std::exp(-1.5), 1e-6);
    EXPECT_NEAR(value("cloud.A", 3, 2), 1.0 - (std::exp(-0.5) + std::exp(-1.0) + std::exp(-1.5)) / 3.0, 1e-6);
    EXPECT_EQ(value("cloud.A", 10, 17), 1.0);
    EXPECT_EQ(value("transmittance.G", 10, 17), 0.0);
    const Camera camera = makeCamera(scene.camera, scene.image, Bounds{});
    const double floor = -10.0 / camera.ray(10.5, 17.5).direction.y;
    EXPECT_NEAR(value("depth.front", 10, 17), floor, 1e-4);
    EXPECT_NEAR(value("depth.Z", 10, 17), floor, 0.1 * floor);
}

TEST(Reference, FogAndSurfacesAreInTheFingerprint) {
    scene::Scene scene = ballScene();
    scene.clouds.clear();
    const auto print = [&] { return Renderer(scene, {}, Majorant::global, 1).fingerprint(); };
    std::vector<std::uint64_t> prints{print()};
    const auto changed = [&](const char* what) {
        prints.push_back(print());
        EXPECT_EQ(std::ranges::count(prints, prints.back()), 1) << what;
    };
    scene.fog.inscattering = false;
    EXPECT_EQ(print(), prints.front()) << "without media it changes nothing";
    scene.fog.media.resize(1);
    scene.fog.media[0].scattering = dvec3(0.1);
    scene.fog.media[0].bottom = 0.0;
    scene.fog.media[0].top = 10.0;
    changed("medium");
    scene.fog.inscattering = true;
    changed("in-scattering");
    scene.fog.media[0].g = 0.1;
    changed("g");
    scene.fog.media[0].emission.y = 0.1;
    changed("emission of a medium");
    scene.fog.skyDistance = 10.0;
    EXPECT_EQ(print(), prints.back()) << "it is for composite alone";
    scene.fog.media[0].top = 20.0;
    changed("top");
    scene.fog.media[0].halfSize.z = 3.0;
    changed("size of a medium");
    scene.surfaces.resize(1);
    changed("surface");
    scene.surfaces[0].emission.z = 1.0;
    changed("emission of a surface");
}

TEST(Reference, WithoutACloudThereIsSky) {
    scene::Scene scene = ballScene();
    scene.clouds.clear();
    Renderer renderer(scene, {}, Majorant::global, 1);
    renderer.pass(goOn);
    const LayeredImage image = renderer.picture();
    for (const float value : image.layers.at("R")) EXPECT_EQ(value, static_cast<float>(scene.sky.radiance.x));
    for (const float value : image.layers.at("depth.front")) EXPECT_EQ(value, 1e10F);
    EXPECT_EQ(image.layers.count("variance.R"), 0U);
}

}  // namespace
}  // namespace lumulus::reference
