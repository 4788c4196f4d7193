// Pictures to be enlarged: their light is coarse, and that of whole pictures is not touched.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/renderer.h"
#include "support/small_scene.h"

namespace lumulus {
namespace {

/// A ball of 48 voxels across, whose light has cells of more than one voxel.
scene::Scene ball() {
    scene::Scene scene = test::smallScene();
    scene.clouds[0].resolution = 48;
    scene.clouds[0].extinction = 0.05;
    scene.photonMap.photons = 40'000;
    return scene;
}

std::unique_ptr<Renderer> tracedRenderer(const scene::Scene& scene) {
    RendererOptions options;
    options.validation = true;
    options.keepRing = true;
    auto renderer = std::make_unique<Renderer>(scene, options);
    for (int i = 0; i < 2; ++i) renderer->traceGeneration();
    return renderer;
}

View coarse(View view) {
    view.coarse = true;
    return view;
}

View seenFrom(const Renderer& renderer, double x) {
    View view = renderer.sceneView();
    view.camera.position = glm::dvec3(x, 300.0, 400.0);
    view.camera.target = glm::dvec3(0.0, 100.0, 0.0);
    return view;
}

/// Sum over pixels and colours of the light of clouds, and of the squares of its difference to another picture.
struct Compared {
    double sum = 0.0, squares = 0.0;

    Compared(const LayeredImage& picture, const LayeredImage& other) {
        for (const char* name : {"cloud.R", "cloud.G", "cloud.B"})
            for (std::size_t i = 0; i < picture.pixels(); ++i) {
                const auto a = static_cast<double>(picture.layers.at(name)[i]);
                sum += a;
                squares += std::pow(a - static_cast<double>(other.layers.at(name)[i]), 2);
            }
    }
};

/// Judged by a picture of forty times the photons, whose cells are half as wide.
TEST(Coarse, LightIsNearThatOfWholePictures) {
    scene::Scene many = ball();
    many.photonMap.photons *= 40;
    const LayeredImage truth = tracedRenderer(many)->draw();
    const auto renderer = tracedRenderer(ball());
    const LayeredImage fine = renderer->draw(), other = renderer->draw(coarse(renderer->sceneView()));
    const Compared whole(fine, truth), large(other, truth);
    EXPECT_GT(Compared(other, fine).squares, 0.0);
    EXPECT_LT(large.squares, 1.5 * whole.squares);
    EXPECT_NEAR(large.sum / whole.sum, 1.0, 0.025);
    EXPECT_EQ(other.layers.at("cloud.A"), fine.layers.at("cloud.A")) << "what hides the background is not coarse";
    EXPECT_TRUE(renderer->statistics().validationMessages.empty());
}

/// Also where one viewer looks at both by turns, from eyes that move.
TEST(Coarse, WholePicturesKeepTheirBits) {
    const auto renderer = tracedRenderer(ball());
    const LayeredImage before = renderer->draw(seenFrom(*renderer, 50.0));
    ViewState viewer, whole;
    for (const double x : {0.0, 50.0, 50.0}) {
        const View view = seenFrom(*renderer, x);
        const LayeredImage first = renderer->draw(coarse(view), viewer);
        const LayeredImage fine = renderer->draw(view, viewer);
        EXPECT_EQ(fine.layers, renderer->draw(view, whole).layers);
        EXPECT_EQ(renderer->draw(coarse(view), viewer).layers, first.layers);
        EXPECT_EQ(fine.layers == before.layers, x == 50.0);
    }
    renderer->traceGeneration();
    const View view = seenFrom(*renderer, 50.0);
    const LayeredImage first = renderer->draw(coarse(view), viewer);
    EXPECT_NE(first.layers, before.layers);
    EXPECT_EQ(first.layers, renderer->draw(coarse(view)).layers) << "a new generation is seen";
}

TEST(Coarse, AnEyeNearbySeesTheSameSky) {
    scene::Scene scene = test::smallScene();
    scene.sky.model = scene::SkyModel::atmosphere;
    const auto renderer = tracedRenderer(scene);
    const auto from = [&](double x, double y) {
        View view = coarse(renderer->sceneView());
        view.camera.position = glm::dvec3(x, y, 900.0);
        view.camera.target = glm::dvec3(0.0, y + 40.0, 0.0);
        return view;
    };
    ViewState viewer;
    renderer->draw(from(0.0, 500.0), viewer);
    for (const auto& [x, y] : {std::pair{3000.0, 500.0}, {-3000.0, 520.0}, {0.0, 4000.0}}) {
        const LayeredImage seen = renderer->draw(from(x, y), viewer), own = renderer->draw(from(x, y));
        for (const char* name : {"R", "G", "B"})
            for (std::size_t i = 0; i < own.pixels(); ++i) {
                const auto expected = static_cast<double>(own.layers.at(name)[i]);
                ASSERT_NEAR(static_cast<double>(seen.layers.at(name)[i]), expected, 0.01 * expected)
                    << name << i << ' ' << x;
            }
    }
}

/// The tables of the sky turn with it, and whole pictures have their own.
TEST(Coarse, ASunThatGoesRoundHasItsSky) {
    scene::Scene scene = test::smallScene();
    scene.sky.model = scene::SkyModel::atmosphere;
    const auto renderer = tracedRenderer(scene);
    View view = renderer->sceneView();
    view.camera.position = glm::dvec3(0.0, 500.0, 900.0);
    view.camera.target = glm::dvec3(0.0, 520.0, 0.0);
    const scene::Sun sun = renderer->sun();
    ViewState viewer;
    const LayeredImage first = renderer->draw(coarse(view), viewer);
    for (const double azimuth : {20.0, 190.0}) {
        ASSERT_TRUE(renderer->setSun(scene::skyDirection(azimuth, 20.0), sun.irradiance));
        ViewState fresh;
        const LayeredImage seen = renderer->draw(coarse(view), viewer), own = renderer->draw(coarse(view), fresh);
        double brightest = 0.0, farthest = 0.0;
        for (const char* name : {"R", "G", "B"})
            for (std::size_t i = 0; i < own.pixels(); ++i) {
                const auto expected = static_cast<double>(own.layers.at(name)[i]);
                brightest = std::max(brightest, std::abs(static_cast<double>(first.layers.at(name)[i]) - expected));
                farthest = std::max(farthest, std::abs(static_cast<double>(seen.layers.at(name)[i]) / expected - 1.0));
            }
        EXPECT_LT(farthest, 1e-3) << azimuth;
        EXPECT_GT(brightest, 0.01) << "the sky has changed";
        EXPECT_EQ(renderer->draw(view, viewer).layers, renderer->draw(view, fresh).layers);
        EXPECT_EQ(renderer->draw(coarse(view), viewer).layers, renderer->draw(coarse(view), fresh).layers);
    }
}

}  // namespace
}  // namespace lumulus
