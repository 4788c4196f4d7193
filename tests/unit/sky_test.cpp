// The sun's disc in a picture: what it adds to pixels is its mean over their solid angles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "frame/background.h"
#include "frame/sun_cover.h"
#include "frame/sun_disc.h"

namespace lumulus::frame {
namespace {

using glm::dvec3;
using std::numbers::pi;

struct Sight {
    scene::Sun sun;
    scene::Camera camera;
    scene::Image image{64, 48, 0.0};

    Sight() {
        sun.directionTo = glm::normalize(dvec3(0.2, 0.1, -1.0));
        sun.irradiance = dvec3(5.0, 4.0, 1.0);
        camera.position = dvec3(0.0);
        camera.target = dvec3(0.0, 0.0, -1.0);
    }
    Camera seen() const { return makeCamera(camera, image, Bounds{}); }
    Tile whole() const { return {0, 0, image.width, image.height}; }

    /// Σ radiance · solid angle of the disc over the picture, pixels by flat quadrilaterals of their corners.
    dvec3 fluence() const {
        const Camera view = seen();
        dvec3 sum(0.0);
        for (const shared::SunPixel& pixel : sunPixels(view, whole(), sun)) {
            const int parts = view.height < 100 ? 16 : 2;
            double angle = 0.0;
            for (int i = 0; i < parts * parts; ++i) {
                const auto to = [&](int x, int y) {
                    return view
                        .ray(pixel.pixel.x + (i % parts + x) / static_cast<double>(parts),
                             pixel.pixel.y + (i / parts + y) / static_cast<double>(parts))
                        .direction;
                };
                angle += 0.5 * glm::length(glm::cross(to(1, 1) - to(0, 0), to(0, 1) - to(1, 0)));
            }
            sum += angle * dvec3(pixel.radiance);
        }
        return sum;
    }
    void expectIrradiance(const char* what) const {
        // a wide disc's fluence is a little above its irradiance, which counts directions by their cosine
        const double radius = 0.5 * sun.angularDiameter * pi / 180.0;
        const double more = 2.0 * (1.0 - std::cos(radius)) / std::pow(std::sin(radius), 2);
        const dvec3 found = fluence();
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], more * sun.irradiance[c], 0.003 * sun.irradiance[c]) << what << " " << c;
    }
};

/// An HDRI of any size holds all of the sun, wherever it stands: beside the poles and across the seam too.
TEST(SunDisc, APanoramaHoldsItsIrradiance) {
    Sight sight;
    sight.camera.projection = scene::Projection::panorama;
    for (const int height : {4, 32, 256}) {
        sight.image = {2 * height, height, 0.0};
        for (const double diameter : {0.05, 0.53, 10.0})
            for (const double elevation : {-90.0, 37.77, 89.6, 90.0})
                for (const double azimuth : {33.3, 179.99}) {
                    const double e = elevation * pi / 180.0, a = azimuth * pi / 180.0;
                    sight.sun.directionTo = {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
                    sight.sun.angularDiameter = diameter;
                    sight.expectIrradiance("panorama");
                    if (testing::Test::HasFailure())
                        FAIL() << height << " " << diameter << " " << elevation << " " << azimuth;
                }
    }
}

/// So does every perspective view that sees the whole disc, off its middle and off axis too.
TEST(SunDisc, APerspectiveViewHoldsItsIrradiance) {
    Sight sight;
    for (const double fov : {10.0, 60.0, 150.0})
        for (const double diameter : {0.05, 0.53, 4.0})
            for (const glm::dvec2& place : {glm::dvec2(0.0), glm::dvec2(0.013, -0.4), glm::dvec2(-0.55, 0.5)}) {
                sight.camera.verticalFov = fov;
                const double half = std::tan(fov * pi / 360.0);
                sight.sun.directionTo = glm::normalize(dvec3(half * place, -1.0));
                sight.sun.angularDiameter = diameter;
                sight.expectIrradiance("perspective");
                if (testing::Test::HasFailure()) FAIL() << fov << " " << diameter << " " << place.x;
            }
}

/// A share is what a fine grid of rays finds.
TEST(SunDisc, SharesAreThoseOfRays) {
    Sight sight;
    sight.image = {20, 15, 0.0};
    sight.sun.angularDiameter = 12.0;
    for (const auto projection : {scene::Projection::perspective, scene::Projection::panorama}) {
        sight.camera.projection = projection;
        const Camera view = sight.seen();
        const double radius = 6.0 * pi / 180.0;
        std::vector<double> shares(300, 0.0);
        for (const CoveredPixel& covered : sunCover(view, sight.whole(), sight.sun.directionTo, radius))
            shares[static_cast<std::size_t>(covered.pixel.y * 20 + covered.pixel.x)] = covered.share;
        for (int y = 0; y < 15; ++y)
            for (int x = 0; x < 20; ++x) {
                constexpr int rays = 40;
                int met = 0;
                for (int i = 0; i < rays * rays; ++i) {
                    const dvec3 direction =
                        view.ray(x + (i % rays + 0.5) / rays, y + (i / rays + 0.5) / rays).direction;
                    met += glm::dot(direction, sight.sun.directionTo) > std::cos(radius) ? 1 : 0;
                }
                // rays are even over the pixel and not over its solid angle: the same but for some percent
                EXPECT_NEAR(shares[static_cast<std::size_t>(y * 20 + x)], met / double{rays * rays}, 0.03)
                    << x << " " << y;
            }
    }
}

/// A disc as large as the sky that a wide view sees: the conic is a hyperbola.
TEST(SunDisc, AHugeDiscAtTheHorizonOfTheView) {
    Sight sight;
    sight.camera.verticalFov = 160.0;
    for (const dvec3 to : {dvec3(1.0, 0.0, -0.2), dvec3(0.1, 1.0, -0.1), dvec3(-1.0, -0.5, 0.1)}) {
        const Camera view = sight.seen();
        const double radius = 40.0 * pi / 180.0;
        std::vector<double> shares(64 * 48, 0.0);
        for (const CoveredPixel& covered : sunCover(view, sight.whole(), to, radius))
            shares[static_cast<std::size_t>(covered.pixel.y * 64 + covered.pixel.x)] = covered.share;
        for (int i = 0; i < 64 * 48; ++i) {
            // pixels that lie wholly on one side of the rim
            int met = 0;
            for (int k = 0; k < 9; ++k) {
                const dvec3 direction = view.ray(i % 64 + 0.5 * (k % 3), i / 64 + 0.5 * (k / 3)).direction;
                met += glm::dot(direction, glm::normalize(to)) > std::cos(radius) ? 1 : 0;
            }
            if (met != 0 && met != 9) continue;
            EXPECT_NEAR(shares[static_cast<std::size_t>(i)], met / 9, 0.02) << i % 64 << " " << i / 64;
        }
    }
}

TEST(SunDisc, ATileHasThePixelsOfTheWhole) {
    Sight sight;
    sight.sun.angularDiameter = 7.0;
    const Tile part{36, 10, 11, 20};
    std::size_t inside = 0;
    const auto tile = sunPixels(sight.seen(), part, sight.sun);
    for (const shared::SunPixel& pixel : sunPixels(sight.seen(), sight.whole(), sight.sun)) {
        const glm::ivec2 at = pixel.pixel - glm::ivec2(part.x, part.y);
        if (at.x < 0 || at.y < 0 || at.x >= part.width || at.y >= part.height) continue;
        ASSERT_LT(inside, tile.size());
        EXPECT_EQ(tile[inside].pixel, at);
        EXPECT_EQ(tile[inside++].radiance, pixel.radiance);
    }
    EXPECT_EQ(inside, tile.size());
    EXPECT_GT(inside, 3U);
}

/// Clouds weaken it, and what is beside it stays.
TEST(SunDisc, IsSeenThroughTheCloud) {
    LayeredImage image = emptyFrame({0, 0, 3, 1}, dvec3(0.5));
    image.layers.at("transmittance.R")[1] = 0.25F;
    addSun(image, {{{0, 0}, {4.0F, 2.0F, 1.0F}}, {{1, 0}, {4.0F, 2.0F, 1.0F}}});
    EXPECT_EQ(image.layers.at("R"), (std::vector<float>{4.5F, 1.5F, 0.5F}));
    EXPECT_EQ(image.layers.at("B"), (std::vector<float>{1.5F, 0.75F, 0.5F}));
}

TEST(SunDisc, AnOrthographicViewSeesItEverywhereOrNowhere) {
    Sight sight;
    sight.camera.projection = scene::Projection::orthographic;
    sight.camera.position = dvec3(0.0, 0.0, 3.0);
    sight.sun.directionTo = glm::normalize(dvec3(0.0, 0.01, -1.0));
    sight.sun.angularDiameter = 2.0;
    EXPECT_EQ(sunCover(sight.seen(), sight.whole(), sight.sun.directionTo, pi / 180.0).size(), 64U * 48U);
    EXPECT_TRUE(sunCover(sight.seen(), sight.whole(), sight.sun.directionTo, 0.1 * pi / 180.0).empty());
}

}  // namespace
}  // namespace lumulus::frame
