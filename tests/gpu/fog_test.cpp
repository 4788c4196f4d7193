// The fog's filters on the GPU: energy, what must stay as it is, and the scattering pyramid against the exact filter.
#include "fog/screen/fog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "shared/draw.h"
#include "support/vulkan_fixture.h"

namespace lumulus::fog {
namespace {

using scene::FogFilter;

Camera cameraOf(int width, int height) {
    Camera camera;
    camera.width = width;
    camera.height = height;
    camera.tanHalfFov = 0.5;
    return camera;
}

scene::Fog fogOf(double scattering, double absorption, double g = 0.9, FogFilter filter = FogFilter::scatter) {
    scene::Fog fog;
    fog.filter = filter;
    fog.media.resize(1);
    fog.media[0].scattering = glm::dvec3(scattering);
    fog.media[0].absorption = glm::dvec3(absorption);
    fog.media[0].g = g;
    return fog;
}

/// Lamps of up to 10⁴ on a dim ground, all as far away.
Layer lamps(const Camera& camera, float distance) {
    const auto count = static_cast<std::size_t>(camera.width * camera.height);
    Layer layer{std::vector<glm::vec4>(count, glm::vec4(0.1F, 0.2F, 0.3F, 1.0F)), std::vector<float>(count, distance)};
    for (std::size_t i = 5; i < count; i += 97) layer.radiance[i] = glm::vec4(1e4F / static_cast<float>(i % 7 + 1));
    return layer;
}

glm::dvec3 sum(const std::vector<glm::vec4>& pixels) {
    return std::accumulate(pixels.begin(), pixels.end(), glm::dvec3(0.0),
                           [](const glm::dvec3& a, const glm::vec4& b) { return a + glm::dvec3(glm::vec3(b)); });
}

class FogTest : public test::VulkanTest {
  protected:
    std::vector<glm::vec4> through(const scene::Fog& scene, const Layer& layer, const Camera& camera) {
        return Fog(context, scene).apply(layer, camera);
    }
};

TEST_F(FogTest, EnergyIsKeptAtUniformDistance) {
    for (const glm::ivec2& size : {glm::ivec2(64, 48), glm::ivec2(61, 37), glm::ivec2(33, 2)}) {
        const Camera camera = cameraOf(size.x, size.y);
        for (const double scattering : {0.001, 0.03, 1.0}) {
            const Layer layer = lamps(camera, 80.0F);
            const glm::dvec3 seen = sum(through(fogOf(scattering, 0.002), layer, camera));
            const glm::dvec3 expected = std::exp(-0.002 * 80.0) * sum(layer.radiance);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.02) << size.x << ' ' << scattering;
        }
    }
}

TEST_F(FogTest, AConstantPictureStaysConstant) {
    const Camera camera = cameraOf(45, 31);
    for (const FogFilter filter : {FogFilter::scatter, FogFilter::naive, FogFilter::gather}) {
        for (const double scattering : {0.0005, 0.02, 0.5}) {
            const Layer layer{std::vector<glm::vec4>(45 * 31, glm::vec4(2.0F)), std::vector<float>(45 * 31, 50.0F)};
            for (const glm::vec4& pixel : through(fogOf(scattering, 0.01, 0.5, filter), layer, camera))
                ASSERT_NEAR(pixel.y, 2.0 * std::exp(-0.5), 2e-3) << static_cast<int>(filter) << ' ' << scattering;
        }
    }
}

TEST_F(FogTest, WithoutScatteringThereIsAttenuationAlone) {
    const Camera camera = cameraOf(24, 16);
    const Layer layer = lamps(camera, 100.0F);
    for (const FogFilter filter : {FogFilter::scatter, FogFilter::masked, FogFilter::naive, FogFilter::gather}) {
        const std::vector<glm::vec4> seen = through(fogOf(0.0, 0.02, 0.9, filter), layer, camera);
        for (std::size_t i = 0; i < seen.size(); ++i) ASSERT_FLOAT_EQ(seen[i].x, std::exp(-2.0F) * layer.radiance[i].x);
    }
}

TEST_F(FogTest, AtDistanceNothingNothingChanges) {
    const Camera camera = cameraOf(24, 16);
    const Layer layer = lamps(camera, 0.0F);
    for (const FogFilter filter : {FogFilter::scatter, FogFilter::masked, FogFilter::naive, FogFilter::gather}) {
        const std::vector<glm::vec4> seen = through(fogOf(0.5, 0.5, 0.2, filter), layer, camera);
        for (std::size_t i = 0; i < seen.size(); ++i)
            ASSERT_EQ(glm::vec3(seen[i]), glm::vec3(layer.radiance[i])) << static_cast<int>(filter);
    }
}

TEST_F(FogTest, TheExactFilterIsAGaussianWithMirrors) {
    const Camera camera = cameraOf(19, 1);
    Layer layer{std::vector<glm::vec4>(19, glm::vec4(0.0F)), std::vector<float>(19, 60.0F)};
    layer.radiance[4] = glm::vec4(1000.0F);
    const double scattering = 0.8, g = 0.9, pixelsPerRadian = 1.0;  // of a height of one pixel and a tangent of 1/2
    const double depth = scattering * 60.0;
    const std::vector<glm::vec4> seen = through(fogOf(scattering, 0.0, g, FogFilter::gather), layer, camera);
    const double spread = std::sqrt(depth * (1.0 - g) / 8.0) * pixelsPerRadian;
    const auto normal = [&](double at) { return 0.5 * std::erf(at / spread / std::sqrt(2.0)); };
    for (int to = 0; to < 19; ++to) {
        double expected = 0.0;
        for (int image = -40; image <= 40; ++image) {
            for (const double offset : {to - 4.0, to + 5.0})
                expected += normal(offset - 38.0 * image + 0.5) - normal(offset - 38.0 * image - 0.5);
        }
        EXPECT_NEAR(seen[static_cast<std::size_t>(to)].x, 1000.0 * expected, 0.01 + 1e-4 * 1000.0 * expected) << to;
    }
}

TEST_F(FogTest, ScatterIsNearTheExactFilterAndTheOthersAreNot) {
    const Camera camera = cameraOf(64, 48);
    Layer layer = lamps(camera, 40.0F);
    for (std::size_t i = 0; i < layer.distances.size(); ++i) layer.distances[i] = i % 64 < 30 ? 40.0F : 300.0F;
    const auto error = [&](FogFilter filter, const std::vector<glm::vec4>& exact) {
        const std::vector<glm::vec4> seen = through(fogOf(0.01, 0.0, 0.9, filter), layer, camera);
        double squares = 0.0;
        for (std::size_t i = 0; i < seen.size(); ++i) squares += std::pow(seen[i].y - exact[i].y, 2);
        return std::sqrt(squares / static_cast<double>(seen.size())) * static_cast<double>(seen.size()) / sum(exact).y;
    };
    const std::vector<glm::vec4> exact = through(fogOf(0.01, 0.0, 0.9, FogFilter::gather), layer, camera);
    const double scatter = error(FogFilter::scatter, exact);
    EXPECT_LT(scatter, 0.5);
    EXPECT_LT(3.0 * scatter, error(FogFilter::masked, exact));
}

TEST_F(FogTest, ExtremesStayFinite) {
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(8191, 3), glm::ivec2(3, 700)}) {
        const Camera camera = cameraOf(size.x, size.y);
        Layer layer = lamps(camera, 10.0F);
        for (std::size_t i = 0; i < layer.distances.size(); ++i) {
            layer.distances[i] = i % 3 == 0 ? shared::FAR_DEPTH : 1e-3F * static_cast<float>(i);
            layer.radiance[i] *= 10.0F;  // up to 10⁵, beyond half floats
        }
        for (const FogFilter filter : {FogFilter::scatter, FogFilter::masked, FogFilter::naive}) {
            for (const double visibility : {1.0, 1e6}) {
                const scene::Fog fog = fogOf(3.912 / visibility, 0.0, 0.9999, filter);
                for (const glm::vec4& pixel : through(fog, layer, camera))
                    ASSERT_TRUE(std::isfinite(pixel.x + pixel.y + pixel.z) && pixel.x >= 0.0F);
            }
        }
    }
}

TEST_F(FogTest, EmissionFillsWhatTheLayerCovers) {
    const Camera camera = cameraOf(8, 8);
    Layer layer{std::vector<glm::vec4>(64, glm::vec4(0.0F, 0.0F, 0.0F, 0.25F)), std::vector<float>(64, 30.0F)};
    scene::Fog fog = fogOf(0.0, 0.1);
    fog.media[0].emission = {1.0, 2.0, 3.0};
    const std::vector<glm::vec4> seen = through(fog, layer, camera);
    EXPECT_NEAR(seen[20].y, 0.25 * 2.0 * (1.0 - std::exp(-3.0)) / 0.1, 1e-4);
}

}  // namespace
}  // namespace lumulus::fog
