// A frame in fog on the GPU, bit for bit as the host makes it of filtered layers, with one download.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <random>

#include "fog/screen/fog.h"
#include "medium/fog_media.h"
#include "shared/fog.h"
#include "support/drawn_frame.h"
#include "support/vulkan_fixture.h"

namespace lumulus::fog {
namespace {

constexpr Tile place{3, 2, 50, 28};
constexpr std::array<const char*, 3> colours{"R", "G", "B"};

Camera pictureCamera() {
    Camera camera;
    camera.width = 64;
    camera.height = 36;
    camera.tanHalfFov = 0.4;
    return camera;
}

scene::Fog haze(double absorption, double emission) {
    scene::Fog fog;
    fog.media.resize(1);
    fog.media[0].scattering = {0.002, 0.003, 0.004};
    fog.media[0].absorption = glm::dvec3(absorption);
    fog.media[0].emission = glm::dvec3(emission);
    return fog;
}

/// Pixels of clouds of all thicknesses before a sky, as drawing leaves them.
std::vector<shared::Pixel> cloudPixels(const glm::vec3& sky, float thickest) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<shared::Pixel> pixels(static_cast<std::size_t>(place.width * place.height));
    for (shared::Pixel& pixel : pixels) {
        pixel.alpha = thickest * std::max(0.0F, uniform(random) - 0.3F);
        pixel.transmittance = 1.0F - pixel.alpha;
        pixel.cloud = pixel.alpha * glm::vec3(uniform(random), uniform(random), uniform(random));
        pixel.radiance = pixel.cloud + pixel.transmittance * sky;
        pixel.depth = pixel.alpha > 0.0F ? 100.0F + 900.0F * uniform(random) : shared::FAR_DEPTH;
        pixel.front = 0.9F * pixel.depth;
    }
    return pixels;
}

LayeredImage download(gpu::Context& context, const frame::Frame& frame, const Tile& part) {
    gpu::Commands commands(context);
    std::vector<gpu::PassTime> times;
    return frame.download(commands, part, times);
}

/// The three layers of a frame, by the host.
struct HostLayers {
    Layer cloud, shadow, bright;
    bool clouded = false, lit = false;
};

HostLayers split(const LayeredImage& image, const glm::vec3& sky) {
    const std::size_t count = image.pixels();
    const std::vector<float> far(count, shared::FAR_DEPTH);
    const std::vector<glm::vec4> black(count, glm::vec4(0.0F));
    HostLayers layers{{black, image.layers.at("depth.Z")}, {black, far}, {black, far}};
    for (std::size_t i = 0; i < count; ++i) {
        layers.cloud.radiance[i].w = image.layers.at("cloud.A")[i];
        layers.clouded = layers.clouded || image.layers.at("cloud.A")[i] > 0.0F;
        for (int c = 0; c < 3; ++c) {
            const std::string name = colours[static_cast<std::size_t>(c)];
            const float light = image.layers.at("cloud." + name)[i];
            const float behind = image.layers.at(name)[i] - light - sky[c];
            layers.cloud.radiance[i][c] = light;
            layers.shadow.radiance[i][c] = std::max(-behind, 0.0F);
            layers.bright.radiance[i][c] = std::max(behind, 0.0F);
            layers.lit = layers.lit || behind > 0.0F;
        }
    }
    return layers;
}

/// The uniform sky and the fog's own light, where a cloud covers `cover` of the pixel.
glm::vec3 openSkyOf(const scene::Fog& fog, const Camera& camera, const glm::vec3& sky, std::size_t i, float cover) {
    const auto x = static_cast<double>(i % static_cast<std::size_t>(camera.width));
    const auto y = static_cast<double>(i / static_cast<std::size_t>(camera.width));
    const glm::vec3 direction(camera.ray(x + 0.5, y + 0.5).direction);
    shared::FogPath path = shared::clearPath();
    for (const shared::FogMedium& medium : mediaAround(fog, camera.position))
        shared::addMedium(path, medium,
                          shared::densityIntegral(medium, glm::vec3(0.0F), direction, shared::FAR_DEPTH,
                                                  static_cast<float>(fog.skyDistance)));
    return glm::exp(-path.absorption) * sky + (1.0F - cover) * shared::emittedRadiance(path);
}

class FogFrameTest : public test::VulkanTest {
  protected:
    /// The clear frame through the fog: its layers filtered on the GPU, and all else on the host.
    LayeredImage byHost(const scene::Fog& scene, LayeredImage image, const glm::vec3& sky) {
        const Camera camera = pictureCamera();
        Fog fog(context, scene);
        const HostLayers layers = split(image, sky);
        const std::vector<glm::vec4> none(image.pixels(), glm::vec4(0.0F));
        const std::vector<glm::vec4> cloud = layers.clouded ? fog.apply(layers.cloud, camera) : none;
        const std::vector<glm::vec4> shadow = layers.clouded ? fog.apply(layers.shadow, camera) : none;
        const std::vector<glm::vec4> bright = layers.lit ? fog.apply(layers.bright, camera) : none;
        for (std::size_t i = 0; i < none.size(); ++i) {
            const glm::vec3 open = openSkyOf(scene, camera, sky, i, image.layers.at("cloud.A")[i]);
            for (int c = 0; c < 3; ++c) {
                const std::string name = colours[static_cast<std::size_t>(c)];
                const float behind = std::max(open[c] - shadow[i][c], 0.0F) + bright[i][c];
                image.layers.at("cloud." + name)[i] = cloud[i][c];
                image.layers.at(name)[i] = cloud[i][c] + behind;
            }
        }
        return image;
    }

    void expectAsByHost(const scene::Fog& scene, const glm::vec3& sky, float thickest,
                        const std::vector<shared::SunPixel>& sun) {
        frame::Frame frame(context, {64, 36});
        test::fillFrame(context, frame, sky, cloudPixels(sky, thickest), place, sun);
        const Tile all{0, 0, 64, 36};
        const LayeredImage expected = byHost(scene, download(context, frame, all), sky);
        Fog(context, scene).apply(frame, pictureCamera(), sky, all);
        for (const auto& [name, values] : download(context, frame, all).layers)
            for (std::size_t i = 0; i < values.size(); ++i)
                ASSERT_EQ(std::bit_cast<std::uint32_t>(values[i]),
                          std::bit_cast<std::uint32_t>(expected.layers.at(name)[i]))
                    << name << ' ' << i;
    }
};

constexpr glm::vec3 blue(0.13F, 0.31F, 0.77F);
const std::vector<shared::SunPixel> sunBeside{{{60, 3}, {5e4F, 4e4F, 3e4F}}, {{61, 3}, {5e3F, 4e3F, 3e3F}}};

TEST_F(FogFrameTest, IsAsTheHostMakesIt) {
    for (const scene::FogFilter filter :
         {scene::FogFilter::scatter, scene::FogFilter::masked, scene::FogFilter::naive, scene::FogFilter::gather}) {
        scene::Fog fog = haze(0.0, 0.0);
        fog.filter = filter;
        expectAsByHost(fog, blue, 1.0F, sunBeside);
    }
}

TEST_F(FogFrameTest, AbsorptionAndEmissionAreAsOnTheHost) {
    for (const auto& [absorption, emission] : {std::pair{3e-4, 0.0}, {0.0, 0.002}, {3e-4, 0.002}}) {
        scene::Fog fog = haze(absorption, emission);
        fog.media[0].kind = scene::MediumKind::exponential;
        fog.media[0].falloff = 0.01;
        expectAsByHost(fog, blue, 1.0F, sunBeside);
    }
}

TEST_F(FogFrameTest, BlackSkyAndNoCloud) {
    expectAsByHost(haze(1e-4, 0.001), glm::vec3(0.0F), 1.0F, {});
    expectAsByHost(haze(1e-4, 0.0), blue, 0.0F, sunBeside);
    expectAsByHost(haze(0.0, 0.001), blue, 0.0F, {});
}

TEST_F(FogFrameTest, BlackLayersAreNotFiltered) {
    const auto passes = [&](float thickest, const std::vector<shared::SunPixel>& sun) {
        frame::Frame frame(context, {64, 36});
        test::fillFrame(context, frame, blue, cloudPixels(blue, thickest), place, sun);
        Fog fog(context, haze(0.0, 0.0));
        fog.apply(frame, pictureCamera(), blue, {0, 0, 64, 36});
        std::vector<std::string> names;
        for (const gpu::PassTime& time : fog.takeTimes()) names.push_back(time.name);
        return names;
    };
    const std::vector<std::string> unfiltered{"fog split", "fog join"};
    const std::vector<std::string> filtered{"fog split", "fog light", "fog down", "fog up", "fog join"};
    EXPECT_EQ(passes(0.0F, {}), unfiltered);
    EXPECT_EQ(passes(0.0F, sunBeside), filtered);
    EXPECT_EQ(passes(1.0F, {}), filtered);
}

/// Neither layers nor pictures go back and forth: the media go up, and a few words tell which layers there are.
TEST_F(FogFrameTest, OnlyAPartIsDownloadedAndOnce) {
    frame::Frame frame(context, {64, 36});
    test::fillFrame(context, frame, blue, cloudPixels(blue, 1.0F), place, sunBeside);
    Fog fog(context, haze(0.0, 0.0));
    fog.apply(frame, pictureCamera(), blue, {0, 0, 64, 36});  // makes what stays
    const gpu::Transfers before = context.transfers();
    fog.apply(frame, pictureCamera(), blue, {0, 0, 64, 36});
    download(context, frame, {0, 0, 64, 36});
    const gpu::Transfers after = context.transfers();
    EXPECT_EQ(after.downloaded - before.downloaded, 64U * 36U * sizeof(shared::Pixel) + 12U);
    EXPECT_LT(after.uploaded - before.uploaded, 200U);
}

/// What the filter needs is cleared on the device: a pyramid of a 4K picture is larger than any buffer may be.
TEST_F(FogFrameTest, NothingGoesUpForTheFilterItself) {
    frame::Frame frame(context, {64, 36});
    test::fillFrame(context, frame, blue, cloudPixels(blue, 1.0F), place, {});
    const std::uint64_t before = context.transfers().uploaded;
    Fog(context, haze(0.0, 0.0)).apply(frame, pictureCamera(), blue, {0, 0, 64, 36});
    EXPECT_LT(context.transfers().uploaded - before, 200U);
}

/// A picture of the host goes up once and comes back once.
TEST_F(FogFrameTest, ALayerOfTheHostGoesUpOnceAndComesBackOnce) {
    const std::size_t pixels = 64 * 36;
    const Layer layer{std::vector<glm::vec4>(pixels, glm::vec4(1.0F)), std::vector<float>(pixels, 50.0F)};
    Fog fog(context, haze(0.0, 0.0));
    fog.apply(layer, pictureCamera());
    const gpu::Transfers before = context.transfers();
    fog.apply(layer, pictureCamera());
    const gpu::Transfers after = context.transfers();
    EXPECT_EQ(after.downloaded - before.downloaded, pixels * 16);
    EXPECT_LT(after.uploaded - before.uploaded, pixels * 20 + 200);
}

}  // namespace
}  // namespace lumulus::fog
