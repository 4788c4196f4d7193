// The error of a picture, measured by paths: pictures that are wrong by what is known.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "reference/difference_filter.h"
#include "reference/metrics.h"
#include "reference/picture_correction.h"
#include "reference/picture_error.h"
#include "reference/render.h"
#include "stat/ball.h"
#include "support/statistics.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;

const auto goOn = [](std::uint64_t) { return true; };
const auto noProgress = [](double) {};

/// A ball in a sky of radiance 1 without a sun.
scene::Scene furnaceScene() {
    scene::Scene scene;
    scene.image = {20, 20, 0.0};
    scene.clouds.resize(1);
    scene.clouds[0].extinction = 0.3;
    scene.clouds[0].phase.g = 0.3;
    scene.clouds[0].albedo = dvec3(1.0);
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.model = scene::SkyModel::constant;
    scene.sky.radiance = dvec3(1.0);
    return scene;
}

/// The same ball, darker, under the sun.
scene::Scene sunnyScene() {
    scene::Scene scene = furnaceScene();
    scene.clouds[0].albedo = dvec3(1.0, 0.98, 0.9);
    scene.sun.irradiance = dvec3(3.0);
    return scene;
}

const vdb::Volume& ball() {
    static const vdb::Volume volume = ballVolume(16, 10.0);
    return volume;
}

PictureError errorOf(const LayeredImage& picture, const scene::Scene& scene, std::uint64_t seed, std::uint64_t paths) {
    return ErrorProbes::trace(picture, PixelPaths(scene, {ball()}), {seed, 0.0, paths}, noProgress)
        .value()
        .errorOf(picture);
}

/// The picture whose cloud has light that is wrong by a factor for each column, before a background that is right.
template <typename Factor>
LayeredImage withWrongCloud(LayeredImage picture, const Factor& factor) {
    for (const std::string channel : {"R", "G", "B"})
        for (std::size_t i = 0; i < picture.pixels(); ++i) {
            float& cloud = picture.layers.at("cloud." + channel)[i];
            const float more = cloud * static_cast<float>(factor(static_cast<int>(i) % picture.width) - 1.0);
            cloud += more;
            picture.layers.at(channel)[i] += more;
        }
    return picture;
}

LayeredImage scaled(LayeredImage picture, double factor) {
    for (const std::string channel : {"R", "G", "B"})
        for (float& value : picture.layers.at(channel)) value *= static_cast<float>(factor);
    return picture;
}

/// The truth of the sunny scene by many paths; its own noise is a tenth of what is measured.
const LayeredImage& truth() {
    static const LayeredImage picture = [] {
        Renderer renderer(sunnyScene(), {ball()}, Majorant::local, 1);
        for (int i = 0; i < 4096; ++i) renderer.pass(goOn);
        return renderer.picture();
    }();
    return picture;
}

/// Standard error of the mean of the truth, over that mean.
double noiseOfTruth() {
    const Comparison same = compare(truth(), truth());
    return *same.relativeBias.standardError / std::sqrt(2.0);
}

TEST(PictureError, OfAFurnaceIsExact) {
    LayeredImage picture;
    picture.width = picture.height = 20;
    for (const std::string channel : {"R", "G", "B"}) {
        picture.layer(channel, 1.0F);
        picture.layer("transmittance." + channel, 0.5F);
    }
    const PictureError none = errorOf(picture, furnaceScene(), 1, 4000);
    EXPECT_EQ(none.pixels, 400U);
    EXPECT_GE(none.paths, 4000U);
    EXPECT_NEAR(none.bias, 0.0, 1e-9);
    EXPECT_NEAR(none.relMse, 0.0, 1e-9);
    for (const std::string channel : {"R", "G", "B"}) std::ranges::fill(picture.layers.at(channel), 1.25F);
    const PictureError bright = errorOf(picture, furnaceScene(), 1, 4000);
    EXPECT_NEAR(bright.bias, 0.2, 1e-9);
    EXPECT_NEAR(bright.biasSigma, 0.0, 0.01) << "weights by brightness are all the same here";
    EXPECT_NEAR(bright.relMse, 0.04 / 1.01, 1e-6);
    EXPECT_EQ(bright.edge, 3) << "an eighth of the height, whole pixels";
    EXPECT_EQ(bright.blocks.size(), 49U);
    for (const ErrorBlock& block : bright.blocks) EXPECT_NEAR(block.bias(), 0.2, 1e-9);
}

TEST(PictureError, FindsAKnownFactor) {
    for (const double factor : {1.05, 0.95}) {
        const LayeredImage wrong = scaled(truth(), factor);
        const PictureError error = errorOf(wrong, sunnyScene(), 2, 400'000);
        const double bias = 1.0 - 1.0 / factor;
        EXPECT_LT(error.biasSigma, 0.005);
        EXPECT_NEAR(error.bias, bias, 4.0 * std::hypot(error.biasSigma, noiseOfTruth()));
        const double noise = *compare(truth(), truth()).referenceNoise;
        const double relMse = compare(truth(), wrong).relMse.value;  // divided by the wrong picture's squares
        EXPECT_NEAR(error.relMse, relMse, 4.0 * error.relMseSigma + noise);
        EXPECT_GT(error.relMse, 0.5 * bias * bias);
        double squares = 0.0;
        for (const ErrorBlock& block : error.blocks)
            squares += std::pow((block.bias() - bias) / block.biasSigma(), 2.0);
        const auto count = static_cast<double>(error.blocks.size());
        EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count) + 0.3) << "t of few pixels";
    }
}

/// The sun's disc outshines the cloud through which it is seen a thousandfold, and no path meets it.
TEST(PictureError, LeavesTheSunsDiscOut) {
    scene::Scene scene = sunnyScene();
    scene.clouds[0].extinction = 0.02;
    const Camera camera = makeCamera(scene.camera, scene.image, boundsOf({ball()}));
    scene.sun.directionTo = camera.axes[2];
    Renderer renderer(scene, {ball()}, Majorant::local, 1);
    for (int i = 0; i < 512; ++i) renderer.pass(goOn);
    LayeredImage picture = renderer.picture();
    const std::vector<float> disc = picture.layers.at("sun.disc");
    const auto seen = static_cast<std::size_t>(std::ranges::count_if(disc, [](float share) { return share > 0.0F; }));
    ASSERT_GT(seen, 0U);
    picture.layers.erase("sun.disc");  // which pictures of photon maps do not have
    const PixelPaths paths(scene, {ball()});
    EXPECT_EQ(countedPixels(paths.opacity(picture)).size() + seen, cloudPixels(picture, picture).size());
    const PictureError error = errorOf(picture, scene, 2, 40'000);
    EXPECT_LT(error.biasSigma, 0.01);
    EXPECT_LT(std::abs(error.bias), 4.0 * error.biasSigma);

    const LayeredImage before = picture;
    ASSERT_TRUE(correct(picture, paths, {3, 0.0, 40'000, 0}, noProgress));
    for (std::size_t i = 0; i < disc.size(); ++i)
        EXPECT_TRUE(disc[i] == 0.0F || picture.layers.at("G")[i] == before.layers.at("G")[i]) << i;
}

/// Two sigma hold in 95 % of the seeds: at least 33 of 40 but once in a thousand times; sigma is what seeds scatter by.
TEST(PictureError, IsWithinItsBoundsAsOftenAsItSays) {
    constexpr int seeds = 40;
    constexpr double factor = 1.02;
    const LayeredImage wrong = scaled(truth(), factor);
    const double bias = 1.0 - 1.0 / factor, relMse = compare(truth(), wrong).relMse.value;
    int biasHeld = 0, relMseHeld = 0;
    test::RunningMean seen, stated;
    for (int seed = 0; seed < seeds; ++seed) {
        const PictureError error = errorOf(wrong, sunnyScene(), static_cast<std::uint64_t>(100 + seed), 16'000);
        biasHeld += std::abs(error.bias - bias) < 2.0 * std::hypot(error.biasSigma, noiseOfTruth()) ? 1 : 0;
        relMseHeld += std::abs(error.relMse - relMse) < 2.0 * error.relMseSigma ? 1 : 0;
        seen.add(error.bias);
        stated.add(error.biasSigma);
    }
    EXPECT_GE(biasHeld, 33);
    EXPECT_GE(relMseHeld, 33);
    const double scatter = seen.standardError() * std::sqrt(double{seeds});
    EXPECT_NEAR(scatter / stated.mean(), 1.0, 4.0 / std::sqrt(2.0 * seeds));
    EXPECT_NEAR(seen.mean(), bias, 4.0 * std::hypot(seen.standardError(), noiseOfTruth()));
}

Correction correctBy(LayeredImage& picture, std::uint64_t seed, std::uint64_t paths, std::uint64_t events = 0) {
    return correct(picture, PixelPaths(sunnyScene(), {ball()}), {seed, 0.0, paths, events}, noProgress).value();
}

/// A cloud that is 20 % too bright on one side and 18 % too dark on the other.
TEST(PictureCorrection, TakesMoreErrorThanItAdds) {
    const LayeredImage wrong = withWrongCloud(truth(), [](int x) { return 1.2 - 0.02 * x; });
    const double before = compare(wrong, truth()).relMse.value;
    LayeredImage some = wrong, more = wrong;
    const Correction told = correctBy(some, 3, 60'000);
    EXPECT_EQ(told.pixels, cloudPixels(wrong, wrong).size());
    EXPECT_GE(told.paths, 60'000U);
    EXPECT_GT(told.events, told.paths);
    EXPECT_EQ(told.lost, 0U);
    correctBy(more, 3, 400'000);
    EXPECT_LT(compare(some, truth()).relMse.value, 0.35 * before);
    EXPECT_LT(compare(more, truth()).relMse.value, 0.2 * before);
    const Comparison left = compare(more, truth());
    EXPECT_NEAR(left.relativeBias.value, 0.0, 0.008) << "four standard errors of 400,000 paths";
    for (const std::string channel : {"R", "G", "B"})
        for (std::size_t i = 0; i < wrong.pixels(); ++i)
            ASSERT_NEAR(more.layers.at(channel)[i] - wrong.layers.at(channel)[i],
                        more.layers.at("cloud." + channel)[i] - wrong.layers.at("cloud." + channel)[i], 1e-5);
}

/// One pixel in the middle is black: with many paths even that is found.
TEST(PictureCorrection, FindsASinglePixel) {
    constexpr std::size_t middle = 10 * 20 + 10;
    LayeredImage picture = truth();
    for (const std::string channel : {"R", "G", "B"}) {
        picture.layers.at(channel)[middle] -= picture.layers.at("cloud." + channel)[middle];
        picture.layers.at("cloud." + channel)[middle] = 0.0F;
    }
    correctBy(picture, 4, 400'000);
    EXPECT_NEAR(picture.layers.at("R")[middle] / truth().layers.at("R")[middle], 1.0, 0.15);
}

/// Of a picture without an error few noisy paths are not taken for one: less is added than the paths' own noise.
TEST(PictureCorrection, OfNothingIsNextToNothing) {
    LayeredImage same = truth();
    const Correction told = correctBy(same, 5, 8000);
    const PictureError error = errorOf(truth(), sunnyScene(), 5, told.paths);
    const auto pixels = static_cast<double>(error.pixels);
    const double noise = error.biasSigma * error.biasSigma * pixels;  // of a single pixel's paths
    EXPECT_LT(compare(same, truth()).relMse.value, 0.1 * noise);
}

TEST(PictureCorrection, RepeatsToTheBitAndEndsWhereItHasTo) {
    const LayeredImage wrong = scaled(truth(), 1.1);
    LayeredImage a = wrong, b = wrong, c = wrong;
    const Correction told = correctBy(a, 6, 20'000);
    correctBy(b, 6, 20'000);
    EXPECT_EQ(a.layers, b.layers);
    const Correction few = correctBy(c, 6, 20'000, 100);
    EXPECT_EQ(few.paths, 2 * few.pixels) << "one round has more events than that";
    EXPECT_LT(few.paths, told.paths);
    LayeredImage d = wrong;
    const PixelPaths paths(sunnyScene(), {ball()});
    EXPECT_GT(told.evenness, 0.1);
    const Correction uneven = correct(d, paths, {6, 0.0, 20'000, 0, 1.0}, noProgress).value();
    EXPECT_FALSE(uneven.made);
    EXPECT_EQ(d.layers, wrong.layers);
    const auto stop = [](double) { throw std::runtime_error("stop"); };
    EXPECT_THROW(correct(c, paths, {1, 1e9, 0, 0}, stop), std::runtime_error);
    LayeredImage sky = truth();
    for (const std::string channel : {"R", "G", "B"})
        std::ranges::fill(sky.layers.at("transmittance." + channel), 1.0F);
    EXPECT_FALSE(correct(sky, paths, {1, 0.0, 1000, 0}, noProgress).has_value());
}

/// A map of a difference of 0.1 in the left half and noise of a known variance everywhere.
DifferenceMap halfWrong(float sigma) {
    DifferenceMap map;
    map.width = 64;
    map.height = 48;
    const std::size_t pixels = 64 * 48;
    map.counted.assign(pixels, 1.0F);
    map.light.assign(pixels, glm::vec3(1.0F));
    map.variance.assign(pixels, sigma * sigma);
    map.difference.resize(pixels);
    Random random(7, 1, 0);
    for (std::size_t i = 0; i < pixels; ++i) {
        double normal = -6.0;  // a sum of twelve
        for (int k = 0; k < 12; ++k) normal += random.uniform();
        map.difference[i] = glm::vec3((i % 64 < 32 ? 0.1F : 0.0F) + sigma * static_cast<float>(normal));
    }
    return map;
}

double errorOfFilter(float sigma) {
    const std::vector<glm::vec3> found = filterDifference(halfWrong(sigma));
    double square = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double off = static_cast<double>(found[i].x) - (i % 64 < 32 ? 0.1 : 0.0);
        square += off * off / static_cast<double>(found.size());
    }
    return square;
}

TEST(DifferenceFilter, KeepsAnEdgeAndTakesTheNoise) {
    EXPECT_LT(errorOfFilter(0.0F), 1e-10) << "without noise it is the difference";
    EXPECT_LT(errorOfFilter(0.01F), 1e-4) << "never worse than the noise";
    EXPECT_LT(errorOfFilter(0.1F), 0.07 * 0.01) << "of a pixel's variance";
    EXPECT_LT(errorOfFilter(1.0F), 0.3 * 0.01) << "of the variance of the difference: nothing but its mean is seen";
    const DifferenceMap map = halfWrong(0.3F);
    double in = 0.0, out = 0.0;
    for (const glm::vec3& value : map.difference) in += static_cast<double>(value.y);
    for (const glm::vec3& value : filterDifference(map)) out += static_cast<double>(value.y);
    EXPECT_NEAR(out, in, 1e-3 * std::abs(in));
}

TEST(PictureError, RepeatsToTheBitAndHasLayers) {
    const PictureError a = errorOf(truth(), sunnyScene(), 5, 4000), b = errorOf(truth(), sunnyScene(), 5, 4000);
    EXPECT_EQ(a.bias, b.bias);
    EXPECT_EQ(a.relMse, b.relMse);
    EXPECT_NE(a.bias, errorOf(truth(), sunnyScene(), 6, 4000).bias);
    LayeredImage picture = truth();
    addErrorLayers(picture, a);
    const ErrorBlock& block = a.blocks[a.blocks.size() / 2];
    bool found = false;
    for (const std::size_t pixel : cloudPixels(picture, picture)) {
        const int x = static_cast<int>(pixel) % 20 - block.x, y = static_cast<int>(pixel) / 20 - block.y;
        if (x < 0 || y < 0 || x >= block.width || y >= block.height) continue;
        found = true;
        EXPECT_FLOAT_EQ(picture.layers.at("error.sigma")[pixel], static_cast<float>(block.sigma));
        EXPECT_FLOAT_EQ(picture.layers.at("error.bias")[pixel],
                        static_cast<float>((block.difference.x + block.difference.y + block.difference.z) / 3.0));
    }
    EXPECT_TRUE(found);
}

TEST(PictureError, EndsWhereItHasTo) {
    LayeredImage sky = truth();
    for (const std::string channel : {"R", "G", "B"})
        std::ranges::fill(sky.layers.at("transmittance." + channel), 1.0F);
    const PixelPaths paths(sunnyScene(), {ball()});
    EXPECT_FALSE(ErrorProbes::trace(sky, paths, {1, 0.0, 1000}, noProgress).has_value());
    const auto stop = [](double) { throw std::runtime_error("stop"); };
    EXPECT_THROW(ErrorProbes::trace(truth(), paths, {1, 1e9, 0}, stop), std::runtime_error);
    const auto timed = ErrorProbes::trace(truth(), paths, {1, 1e-6, 0}, noProgress).value().errorOf(truth());
    EXPECT_EQ(timed.paths % 2, 0U);
    EXPECT_LT(timed.paths, 2000U) << "one round, however short the time";
}

}  // namespace
}  // namespace lumulus::reference
