// Tone curves and exposure: greys known from their sources, and pictures that do not depend on the unit of radiance.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <vector>

#include "base/display_transform.h"
#include "base/error.h"
#include "base/exposure.h"
#include "base/tonemap.h"
#include "support/temporary_folder.h"

namespace lumulus {
namespace {

constexpr std::array curves{ToneCurve::filmic, ToneCurve::agx, ToneCurve::aces, ToneCurve::neutral, ToneCurve::linear};

Colour grey(double value) {
    return {value, value, value};
}

TEST(ToneCurves, GreysOfTheirSources) {
    constexpr std::array radiances{0.18, 1.0, 4.0};
    constexpr std::array neutral{0.1400, 0.8691, 0.9833}, aces{0.1056, 0.6191, 0.9090}, agx{0.497, 0.787, 0.934};
    for (std::size_t i = 0; i < radiances.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(neutralCurve(grey(radiances[i]))[c], neutral[i], 1e-4);
            EXPECT_NEAR(acesCurve(grey(radiances[i]))[c], aces[i], 1e-4);
            EXPECT_NEAR(agxEncoded(grey(radiances[i]))[c], agx[i], 5e-4);
        }
    }
    EXPECT_NEAR(srgbEncoded(0.18), 0.4614, 1e-4);
    EXPECT_NEAR(displayed(ToneCurve::linear, grey(0.5))[0], 0.7354, 1e-4);
}

TEST(ToneCurves, RiseWithGreyAndStayWithinTheDisplay) {
    for (const ToneCurve curve : curves) {
        double last = 0.0;
        for (int step = -400; step <= 400; ++step) {
            const Colour shown = displayed(curve, grey(std::exp2(step / 16.0)));
            EXPECT_GE(shown[1], last - 2e-4)
                << static_cast<int>(curve) << " " << step;  // the polynomial of AgX at its end
            last = shown[1];
            for (const double channel : shown) EXPECT_TRUE(channel >= 0.0 && channel <= 1.0);
        }
        EXPECT_GT(last, 0.98);
    }
}

TEST(ToneCurves, NothingButNumbersComesOut) {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const ToneCurve curve : curves)
        for (const Colour& colour : {Colour{nan, 1.0, inf}, Colour{-1.0, -inf, nan}, Colour{inf, inf, inf}})
            for (const double channel : displayed(curve, colour))
                EXPECT_TRUE(channel >= 0.0 && channel <= 1.0) << static_cast<int>(curve);
}

TEST(ToneCurves, NeutralKeepsColoursBelowTheShoulder) {
    const Colour colour{0.5, 0.2, 0.1};
    const Colour shown = neutralCurve(colour);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], colour[c] - 0.04, 1e-12);
}

/// A picture of a cloud whose luminances are 1 … `pixels` in units of `unit`, over a share of the sky.
LayeredImage picture(int pixels, double cover, double unit) {
    LayeredImage image;
    image.width = pixels;
    image.height = 1;
    for (const char* name : {"R", "G", "B", "A", "cloud.R", "cloud.G", "cloud.B", "cloud.A"}) image.layer(name);
    for (int i = 0; i < pixels; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const bool cloudy = i < cover * pixels;
        const double alpha = i % 2 == 0 ? 1.0 : 0.5;
        for (const char* name : {"cloud.R", "cloud.G", "cloud.B"})
            image.layers[name][at] = cloudy ? static_cast<float>(unit * (i + 1) * alpha) : 0.0F;
        image.layers["cloud.A"][at] = cloudy ? static_cast<float>(alpha) : 0.0F;
        for (const char* name : {"R", "G", "B"}) image.layers[name][at] = static_cast<float>(unit * (i + 1));
        image.layers["A"][at] = 1.0F;
    }
    return image;
}

double gainOf(const LayeredImage& image) {
    const std::array pictures{&image};
    return meteredGain(pictures);
}

TEST(Exposure, TheCloudsPercentileBecomesFourFifths) {
    EXPECT_NEAR(gainOf(picture(1000, 1.0, 2.0)) * 2.0 * 980.0, 0.8, 0.8 * 0.003);
    // below 2 % of cloud, the median of the picture
    EXPECT_NEAR(gainOf(picture(1000, 0.01, 2.0)) * 2.0 * 500.0, 0.18, 0.18 * 0.004);
    // the sun's disc is no cloud
    LayeredImage sunny = picture(1000, 0.5, 1.0);
    const double without = gainOf(sunny);
    for (const char* name : {"R", "G", "B"}) sunny.layers[name][999] = 1e9F;
    EXPECT_EQ(gainOf(sunny), without);
}

TEST(Exposure, ThePictureDoesNotDependOnTheUnitOfRadiance) {
    const LayeredImage one = picture(777, 0.6, 1.0);
    const std::vector<std::uint8_t> expected = toneMap(one, Tone{0.0, gainOf(one)});
    for (const double unit : {1e-6, 0.37, 1.09, 54321.0}) {
        const LayeredImage other = picture(777, 0.6, unit);
        EXPECT_NEAR(gainOf(other) * unit / gainOf(one), 1.0, 1e-5);
        const std::vector<std::uint8_t> shown = toneMap(other, Tone{0.0, gainOf(other)});
        for (std::size_t i = 0; i < shown.size(); ++i) EXPECT_NEAR(shown[i], expected[i], 1) << unit;
    }
}

/// A planet below a sky that grows darker with height, to black: it never turns white, nor does its grey jump.
TEST(Exposure, FromHighAboveThePlanetIsSeen) {
    const auto shown = [](double sky, double planet) {
        LayeredImage image = picture(1000, 0.0, 1.0);
        for (const char* name : {"R", "G", "B"})
            for (std::size_t i = 0; i < 1000; ++i)
                image.layers[name][i] = static_cast<float>(static_cast<double>(i) < 1000.0 * planet ? 1.0 : sky);
        return gainOf(image);
    };
    EXPECT_NEAR(shown(0.5, 0.45), 0.18 / 0.5, 1e-6);
    double last = shown(0.5, 0.45);
    for (double sky = 0.4; sky > 1e-6; sky *= 0.8) {
        const double now = shown(sky, 0.45);
        EXPECT_LE(now, 0.6 + 1e-6) << sky;
        EXPECT_LT(now / last, 1.3) << sky;
        last = now;
    }
    EXPECT_NEAR(shown(0.0, 0.45), 0.6, 1e-6);
    EXPECT_NEAR(shown(0.0, 0.1), 0.18, 1e-6) << "small as from the moon";
}

TEST(Exposure, BlackAndBrokenPicturesHaveAGain) {
    EXPECT_EQ(gainOf(picture(10, 1.0, 0.0)), 1.0);
    LayeredImage image = picture(10, 1.0, 1.0);
    image.layers["cloud.G"][3] = std::numeric_limits<float>::quiet_NaN();
    image.layers["cloud.G"][4] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(std::isfinite(gainOf(image)));
    EXPECT_EQ(gainOf(LayeredImage{}), 1.0);
}

TEST(Exposure, Ev100IsThatOfACamera) {
    // white at EV 15 is 1.2 · 2^15 = 39322 cd/m²
    EXPECT_NEAR(gainOfEv100(15.0) * 39321.6 / 683.0, 1.0, 1e-12);
    EXPECT_NEAR(ev100OfGain(gainOfEv100(-3.5)), -3.5, 1e-12);
}

TEST(ToneMap, GainAndStopsMultiply) {
    LayeredImage image = picture(64, 1.0, 0.01);
    EXPECT_EQ(toneMap(image, Tone{1.0, 4.0}), toneMap(image, 3.0));
}

class OpenColorIo : public testing::Test {
  protected:
    ~OpenColorIo() override { ::unsetenv("OCIO"); }
    test::TemporaryFolder folder;
    void use(const char* text) {
        std::ofstream(folder / "config.ocio") << text;
        ::setenv("OCIO", (folder / "config.ocio").c_str(), 1);
    }
};

TEST_F(OpenColorIo, IsNotThereWithoutTheVariable) {
    ::unsetenv("OCIO");
    EXPECT_FALSE(DisplayTransform::ofEnvironment().has_value());
    ::setenv("OCIO", "", 1);
    EXPECT_FALSE(DisplayTransform::ofEnvironment().has_value());
}

TEST_F(OpenColorIo, AFaultyConfigurationIsNamed) {
    use("no configuration");
    EXPECT_THROW(DisplayTransform::ofEnvironment(), InputError);
    ::setenv("OCIO", "/nowhere/config.ocio", 1);
    EXPECT_THROW(DisplayTransform::ofEnvironment(), InputError);
}

#ifdef LUMULUS_OPEN_COLOR_IO
TEST_F(OpenColorIo, TheDefaultViewTakesThePlaceOfTheToneMap) {
    use(R"(ocio_profile_version: 2
roles: {scene_linear: scene, default: scene}
displays:
  screen:
    - !<View> {name: square, colorspace: out}
active_displays: [screen]
active_views: [square]
colorspaces:
  - !<ColorSpace> {name: scene, isdata: false}
  - !<ColorSpace>
    name: out
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
)");
    const auto display = DisplayTransform::ofEnvironment();
    ASSERT_TRUE(display.has_value());
    std::vector<Colour> pixels{{0.25, 0.01, 4.0}, {-1.0, std::numeric_limits<double>::quiet_NaN(), 1.0}};
    display->apply(pixels);
    EXPECT_NEAR(pixels[0][0], 0.5, 1e-4);
    EXPECT_NEAR(pixels[0][1], 0.1, 1e-4);
    EXPECT_EQ(pixels[0][2], 1.0);
    EXPECT_EQ(pixels[1][0], 0.0);
    EXPECT_EQ(pixels[1][1], 0.0);
    Tone tone{0.0, 1.0, ToneCurve::filmic, &*display};
    LayeredImage image = picture(4, 1.0, 0.0);
    for (const char* name : {"R", "G", "B"}) image.layers[name] = std::vector<float>(4, 0.25F);
    for (const std::uint8_t value : toneMap(image, tone)) EXPECT_NEAR(value, 127.5, 1.0);
}
#endif

}  // namespace
}  // namespace lumulus
