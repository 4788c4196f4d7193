// The plot of error against time: the same drawing as SVG and as PNG, of which the pixels are looked at.
#include "bench/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <string>
#include <vector>

namespace lumulus::bench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Texel = std::array<int, 3>;
constexpr Texel white{255, 255, 255}, orange{194, 64, 12}, blue{28, 79, 217}, grey{84, 84, 84};

struct Picture {
    int width = 0, height = 0;
    std::vector<png_byte> bytes;

    /// At a place in the pixels of the drawing; the file has two texels for each.
    Texel at(double x, double y) const {
        const std::size_t first = 3 * (static_cast<std::size_t>(2.0 * y) * static_cast<std::size_t>(width) +
                                       static_cast<std::size_t>(2.0 * x));
        return {bytes.at(first), bytes.at(first + 1), bytes.at(first + 2)};
    }
    int count(const Texel& wanted) const {
        int found = 0;
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            found += Texel{bytes[i], bytes[i + 1], bytes[i + 2]} == wanted ? 1 : 0;
        }
        return found;
    }
};

Picture decoded(const std::vector<std::byte>& file) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    Picture picture;
    if (png_image_begin_read_from_memory(&image, file.data(), file.size()) == 0) return picture;
    image.format = PNG_FORMAT_RGB;
    picture.bytes.resize(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, picture.bytes.data(), 0, nullptr) == 0) return picture;
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    return picture;
}

std::string textOf(const std::vector<std::byte>& file) {
    return {reinterpret_cast<const char*>(file.data()), file.size()};
}

Row row(Method method, double seconds, double relMse, double deviation = 0.0) {
    Row result;
    result.method = method;
    result.warmSeconds.mean = seconds;
    result.seconds.mean = 10.0 * seconds;
    result.relMse = {relMse, deviation};
    return result;
}

// The grid of the drawing: seconds from x 80 to 700, relMSE from y 446 up to 86.
constexpr double left = 80.0, right = 700.0, top = 86.0, bottom = 446.0;

/// x over 1…100, y over .01…1: what lies at 10 and .1 lies in the middle.
TEST(Plot, PlacesPointsOnLogarithmicAxes) {
    const std::vector<Row> rows{row(Method::render, 1.0, 1.0), row(Method::render, 10.0, 0.1)};
    const Picture picture = decoded(errorPlot(rows, "", 0.01).png);
    ASSERT_EQ(picture.width, 1440);
    ASSERT_EQ(picture.height, 1000);
    const double x = 0.5 * (left + right), y = 0.5 * (top + bottom);
    EXPECT_EQ(picture.at(x, y), orange) << "without warm-up: at 10 s";
    EXPECT_EQ(picture.at(right - 1.5, y), white) << "whole: at 100 s, hollow";
    EXPECT_EQ(picture.at(right - 3.4, y), orange) << "its rim";
    EXPECT_EQ(picture.at(0.5 * (x + left), y - 0.25 * (bottom - top)), orange) << "half way on the straight line";
    EXPECT_EQ(picture.at(x, y + 20.0), (Texel{186, 186, 186})) << "the line of the grid at 10 s";
}

TEST(Plot, DrawsBarsOfOneDeviationAndTheFloor) {
    // y over .001…1 because of the floor; the bar at .1 goes from .01 to .19
    const std::vector<Row> rows{row(Method::pathTracer, 10.0, 0.1, 0.09), row(Method::pathTracer, 1.0, 1.0)};
    const Picture picture = decoded(errorPlot(rows, "", 2e-3).png);
    const double x = 0.5 * (left + right), decade = (bottom - top) / 3.0;
    const double y = top + decade;  // .1
    EXPECT_EQ(picture.at(x, y), blue);
    EXPECT_EQ(picture.at(x, y + decade - 2.0), blue) << "just above .01";
    EXPECT_NE(picture.at(x, y + decade + 2.0), blue);
    EXPECT_EQ(picture.at(x, y - 0.2787 * decade + 2.0), blue) << "just below .19: its logarithm is −.7213";
    EXPECT_NE(picture.at(x, y - 0.2787 * decade - 2.0), blue);
    const double floor = bottom - 0.30103 * decade;
    int dashes = 0;
    for (double at = left; at < right; at += 0.5) dashes += picture.at(at, floor) == grey ? 1 : 0;
    EXPECT_NEAR(dashes / (2.0 * (right - left)), 0.4, 0.05) << "two pixels of five";
}

TEST(Plot, HoldsEverySeries) {
    const std::vector<Row> rows{row(Method::render, 1.0, 0.1), row(Method::pathTracer, 2.0, 0.3)};
    const Plot both = errorPlot(rows, "two", 2e-4);
    const Plot one = errorPlot(std::span(rows).first(1), "two", 2e-4);
    EXPECT_GT(decoded(both.png).count(blue), decoded(one.png).count(blue) + 20);
    const std::string svg = textOf(both.svg);
    EXPECT_THAT(svg, StartsWith("<?xml"));
    EXPECT_THAT(svg, HasSubstr("width=\"720px\" height=\"500px\" viewBox=\"0 0 720 500\""));
    EXPECT_THAT(svg, EndsWith("</svg>\n"));
    EXPECT_LT(svg.size(), 200'000U);
}

TEST(Plot, LeavesOutWhatLogarithmsCannotShow) {
    const std::vector<Row> rows{row(Method::render, 1.0, -1e-5), row(Method::pathTracer, 1.0, 0.0)};
    const Plot plot = errorPlot(rows, "below", std::nullopt), empty = errorPlot({}, "below", std::nullopt);
    EXPECT_EQ(plot.png, empty.png);
    EXPECT_THAT(textOf(plot.svg), Not(HasSubstr("nan")));
    EXPECT_THAT(textOf(plot.svg), Not(HasSubstr("inf")));
}

/// A name of a file may hold any bytes; signs of XML and letters beyond ASCII are drawn as they are.
TEST(Plot, TakesAnyTitle) {
    const std::vector<Row> rows{row(Method::render, 1.0, 0.1)};
    const auto png = [&](const char* title) { return errorPlot(rows, title, 0.01).png; };
    EXPECT_EQ(png("a\xFF\x80z.toml"), png("a??z.toml"));
    EXPECT_NE(png("Wölkchen <&>"), png("W??lkchen <&>"));
    EXPECT_EQ(png("again"), png("again")) << "an error of Cairo would last";
}

}  // namespace
}  // namespace lumulus::bench
