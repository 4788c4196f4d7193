#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/number_table.h"
#include "query/media.h"

namespace lumulus::query {
namespace {

scene::FogMedium haze(const glm::dvec3& scattering) {
    scene::FogMedium medium;
    medium.scattering = scattering;
    medium.absorption = glm::dvec3(1e-5);
    return medium;
}

TEST(QueryMedia, FogIsInClosedFormForEachChannel) {
    Media media;
    media.fog.media.push_back(haze({1e-4, 2e-4, 4e-4}));
    media.fog.media.push_back(haze({0.0, 1e-3, 0.0}));
    media.fog.media.back().kind = scene::MediumKind::exponential;
    media.fog.media.back().falloff = 0.002;
    const double height = 1000.0, b = 0.002;
    const Passage up = media.along(Way::between({1e7, 0.0, 1e7}, {1e7, height, 1e7}));
    const double thin = (1.0 - std::exp(-b * height)) / b;
    const glm::dvec3 wanted(1.1e-4 * height + 1e-5 * thin, 2.1e-4 * height + 1.01e-3 * thin,
                            4.1e-4 * height + 1e-5 * thin);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(up.opticalDepth[channel], wanted[channel], 1e-5 * wanted[channel]);
        EXPECT_NEAR(up.transmittance()[channel], std::exp(-wanted[channel]), 1e-5);
    }
    EXPECT_EQ(media.along(Way::between({5.0, 0.0, 0.0}, {5.0, 0.0, 0.0})).opticalDepth, glm::dvec3(0.0));
    // media without an end stop at the distance of the sky
    const Passage far = media.along({{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}});
    EXPECT_NEAR(far.opticalDepth.x, 1.1e-4 * media.fog.skyDistance + 1e-5 / b, 1e-4);
}

TEST(QueryMedia, NoSunComesThroughTheGround) {
    Media media;
    const std::array<glm::dvec3, 2> points{glm::dvec3(0.0, 10.0, 0.0), glm::dvec3(0.0, -10.0, 0.0)};
    const glm::dvec3 above = scene::skyDirection(0.0, 30.0), below = scene::skyDirection(0.0, -1.0);
    const auto share = [&](const glm::dvec3& direction, std::size_t point) {
        return towardsSun(media, points, direction, stopIfInterrupted)[point].transmittance().x;
    };
    EXPECT_EQ(share(below, 1), 1.0);
    media.ground = 0.0;
    EXPECT_EQ(share(above, 0), 1.0);
    EXPECT_EQ(share(above, 1), 0.0);
    EXPECT_EQ(share(below, 0), 0.0);
}

TEST(QueryMedia, AShadowHasItsRowsAlongZ) {
    scene::Scene scene;
    scene.clouds.resize(1);
    scene.clouds[0].procedural = "sphere";  // of radius 100 m about (0, 100, 0)
    scene.clouds[0].resolution = 24;
    const Media media = mediaOf(scene, loadClouds(scene));
    const LayeredImage image =
        groundShadow(media, {-300.0, -500.0, 300.0, 500.0, 0.0, 6, 5}, {0.0, 1.0, 0.0}, stopIfInterrupted);
    const std::vector<float>& red = image.layers.at("R");
    EXPECT_EQ(red.size(), 30);
    for (std::size_t i = 0; i < red.size(); ++i) {
        const bool under = i / 6 == 2 && (i % 6 == 2 || i % 6 == 3);  // x = ±50, z = 0
        EXPECT_EQ(red[i] < 0.5F, under) << i;
        EXPECT_EQ(red[i] == 1.0F, !under) << i;
    }
    // a sun in the south throws the shadow to the north: 100 m for each 100 m of height
    const LayeredImage north = groundShadow(media, {-300.0, -500.0, 300.0, 500.0, 0.0, 6, 10},
                                            scene::skyDirection(180.0, 45.0), stopIfInterrupted);
    EXPECT_LT(north.layers.at("R")[4 * 6 + 2], 0.5F);  // z = -50
    EXPECT_EQ(north.layers.at("R")[6 * 6 + 2], 1.0F);  // z = +150
}

constexpr std::array<std::string_view, 3> names{"x", "y", "z"};

TEST(NumberTable, TakesRowsWithAndWithoutNames) {
    for (const char* text :
         {"x,y,z\n1,2,3\n-4e2, +5.5 ,6\r\n\n", "1,2,3\n-400,5.5,6", "\xEF\xBB\xBFx, y, z\n1,2,3\n-400,5.5,6\n"}) {
        const NumberTable table = parseNumberTable(text, names, "a.csv", 10);
        EXPECT_THAT(table.numbers, testing::ElementsAre(1.0, 2.0, 3.0, -400.0, 5.5, 6.0)) << text;
        EXPECT_EQ(table.rows(), 2);
    }
    EXPECT_EQ(parseNumberTable("", names, "a.csv", 10).rows(), 0);
}

TEST(NumberTable, NamesFileAndRowOfWhatIsWrong) {
    const auto saidOf = [](const char* text) -> std::string {
        try {
            parseNumberTable(text, names, "a.csv", 2);
        } catch (const InputError& e) {
            return e.what();
        }
        return "taken";
    };
    EXPECT_THAT(saidOf("x,y,z\n1,2,3\n1,two,3\n"), testing::StartsWith("y = \"two\" is no number (a.csv:3)"));
    EXPECT_THAT(saidOf("1,2\n"), testing::StartsWith("2 of 3 numbers (a.csv:1)"));
    EXPECT_THAT(saidOf("1,2,3,4\n"), testing::StartsWith("more than 3 numbers (a.csv:1)"));
    EXPECT_THAT(saidOf("1,,3\n"), testing::StartsWith("y = \"\" is no number (a.csv:1)"));
    for (const char* text : {"1,nan,3\n", "1,inf,3\n", "1,1e999,3\n", "1,-2e9,3\n"})
        EXPECT_THAT(saidOf(text), testing::HasSubstr("is not within ±1e9 (a.csv:1)")) << text;
    EXPECT_THAT(saidOf("a,b,c\n1,2,3\n"), testing::HasSubstr("neither numbers nor the names of columns (a.csv:1)"));
    EXPECT_THAT(saidOf("1,2,3\n1,2,3\n1,2,3\n"), testing::StartsWith("more than 2 rows (a.csv)"));
}

}  // namespace
}  // namespace lumulus::query
