#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>
#include <png.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/exr.h"
#include "base/png.h"
#include "base/tonemap.h"
#include "support/temporary_folder.h"

namespace lumulus {
namespace {

using test::readAll;
using test::TemporaryFolder;

LayeredImage sampleImage(int width, int height) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    int number = 0;
    for (const char* name : {"R", "G", "B", "A", "cloud.R", "depth.Z", "depth.front"}) {
        std::vector<float>& values = image.layer(name);
        for (float& value : values) {
            ++number;
            value = std::ldexp(static_cast<float>(number % 97), number % 41 - 20);
        }
    }
    image.attributes["scene"] = "scenes/a ü.toml";
    image.attributes["seconds"] = "1.5";
    return image;
}

TEST(Exr, RoundTripIsExact) {
    const TemporaryFolder folder;
    LayeredImage image = sampleImage(37, 21);
    image.layer("R")[0] = std::numeric_limits<float>::max();
    image.layer("R")[1] = std::numeric_limits<float>::denorm_min();
    image.layer("R")[2] = -0.0F;
    writeExr(folder / "a.exr", image);
    const LayeredImage back = readExr(folder / "a.exr");
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 21);
    EXPECT_EQ(back.layers, image.layers);
    EXPECT_TRUE(std::signbit(back.layers.at("R")[2]));
    EXPECT_EQ(back.attributes, image.attributes);
}

TEST(Exr, KeepsItsWindows) {
    const TemporaryFolder folder;
    const LayeredImage image = sampleImage(8, 5);
    const ExrWindows windows{{0, 0, 16, 9}, {-3, 6, 8, 5}};
    writeExr(folder / "a.exr", image, windows);
    const std::vector<ExrPart> parts = listExrParts(folder / "a.exr");
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].windows, windows);
    EXPECT_THAT(parts[0].channels, testing::Contains("depth.front"));
    const std::vector<std::string> some{"cloud.R", "A"};
    const LayeredImage back = readExrChannels(folder / "a.exr", 0, some);
    EXPECT_EQ(back.layers.size(), 2U);
    for (const std::string& name : some) EXPECT_EQ(back.layers.at(name), image.layers.at(name));
    writeExr(folder / "b.exr", image);
    const ExrWindow whole{0, 0, 8, 5};
    EXPECT_EQ(listExrParts(folder / "b.exr").at(0).windows, (ExrWindows{whole, whole}));
}

TEST(Exr, SameImageSameBytes) {
    const TemporaryFolder folder;
    writeExr(folder / "a.exr", sampleImage(50, 40));
    writeExr(folder / "b.exr", sampleImage(50, 40));
    EXPECT_EQ(readAll(folder / "a.exr"), readAll(folder / "b.exr"));
}

TEST(Exr, AttributesOfTheFormatAreRefused) {
    const TemporaryFolder folder;
    for (const char* name : {"compression", "version"}) {
        LayeredImage image = sampleImage(2, 2);
        image.attributes[name] = "x";
        EXPECT_THROW(writeExr(folder / "a.exr", image), InputError) << name;
    }
    EXPECT_EQ(folder.files(), 0U);
}

TEST(Exr, ReadsHalfAndUnsignedInAShiftedWindow) {
    const TemporaryFolder folder;
    const std::vector<Imath::half> halves{0.5F, 1.5F, 2.5F, 3.5F, 4.5F, 5.5F};
    const std::vector<unsigned> whole{1, 2, 3, 4, 5, 6};
    const Imath::Box2i window({-3, 10}, {-1, 11});
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    header.compression() = Imf::PIZ_COMPRESSION;
    header.channels().insert("h", Imf::Channel(Imf::HALF));
    header.channels().insert("u", Imf::Channel(Imf::UINT));
    Imf::FrameBuffer frame;
    frame.insert("h", Imf::Slice::Make(Imf::HALF, halves.data(), window));
    frame.insert("u", Imf::Slice::Make(Imf::UINT, whole.data(), window));
    {
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(2);
    }
    const LayeredImage image = readExr(folder / "a.exr");
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.layers.at("h"), (std::vector<float>{0.5F, 1.5F, 2.5F, 3.5F, 4.5F, 5.5F}));
    EXPECT_EQ(image.layers.at("u"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST(Exr, ReadsTiles) {
    const TemporaryFolder folder;
    const LayeredImage image = sampleImage(20, 11);
    Imf::Header header(20, 11);
    header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    {
        Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("R", Imf::Slice::Make(Imf::FLOAT, image.layers.at("R").data(), Imath::Box2i({0, 0}, {19, 10})));
        file.setFrameBuffer(frame);
        for (int level = 0; level < file.numLevels(); ++level) {
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    EXPECT_EQ(readExr(folder / "a.exr").layers.at("R"), image.layers.at("R"));
}

TEST(Exr, EveryTruncationIsRefused) {
    const TemporaryFolder folder;
    LayeredImage image;
    image.width = 2;
    image.height = 17;  // two blocks of rows
    image.layer("R") = std::vector<float>(34, 0.5F);
    writeExr(folder / "a.exr", image);
    const std::string bytes = readAll(folder / "a.exr");
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        test::writeAll(folder / "cut.exr", bytes.substr(0, length));
        EXPECT_THROW(readExr(folder / "cut.exr"), InputError) << length << " of " << bytes.size();
    }
    EXPECT_THROW(readExr(folder / "missing.exr"), InputError);
    EXPECT_THROW(readExr(folder.path()), InputError);
}

TEST(Exr, HugeClaimsAreRefused) {
    const TemporaryFolder folder;
    writeExr(folder / "a.exr", sampleImage(9, 20));
    std::string bytes = readAll(folder / "a.exr");
    // the window's corner follows the attribute's name, type and size
    const std::size_t corner = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4 + 8;
    for (const std::size_t offset : {corner, corner + 4}) {
        std::string broken = bytes;
        broken.replace(offset, 4, std::string("\xff\xff\xff\x0f", 4));
        test::writeAll(folder / "b.exr", broken);
        EXPECT_THROW(readExr(folder / "b.exr"), InputError);
    }
}

TEST(Png, ReadsBack) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> rgb(7 * 5 * 3);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i * 37);
    writePng(folder / "a.png", 7, 5, rgb);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()), 0);
    EXPECT_EQ(image.width, 7U);
    EXPECT_EQ(image.height, 5U);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
    ASSERT_NE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr), 0);
    EXPECT_EQ(back, rgb);
}

TEST(Png, ReadsBackWithAlpha) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> rgba(7 * 5 * 4);
    for (std::size_t i = 0; i < rgba.size(); ++i) rgba[i] = static_cast<std::uint8_t>(i * 37);
    writePng(folder / "a.png", 7, 5, rgba);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()), 0);
    EXPECT_EQ(image.format & PNG_FORMAT_FLAG_ALPHA, PNG_FORMAT_FLAG_ALPHA);
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
    ASSERT_NE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr), 0);
    EXPECT_EQ(back, rgba);
}

LayeredImage greyImage(const std::vector<float>& values) {
    LayeredImage image;
    image.width = static_cast<int>(values.size());
    image.height = 1;
    for (const char* name : {"R", "G", "B"}) image.layer(name) = values;
    return image;
}

TEST(ToneMap, IsMonotoneWhateverTheDither) {
    std::vector<int> last(64, 0);
    for (int step = 0; step <= 400; ++step) {
        const float radiance = std::exp2(static_cast<float>(step - 300) / 20.0F);
        const std::vector<std::uint8_t> rgb = toneMap(greyImage(std::vector<float>(64, radiance)), 0.0);
        for (std::size_t x = 0; x < 64; ++x) {
            EXPECT_GE(rgb[x * 3], last[x]) << radiance;
            last[x] = rgb[x * 3];
        }
    }
    for (const int value : last) EXPECT_EQ(value, 255);
}

TEST(ToneMap, KnownGrey) {
    // Narkowicz's curve by hand: 0.18 → 0.267; in sRGB 0.554 → 141.2 of 255
    const double x = 0.18;
    const double curve = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    const double expected = 255.0 * (1.055 * std::pow(curve, 1.0 / 2.4) - 0.055);
    const std::vector<std::uint8_t> rgb = toneMap(greyImage(std::vector<float>(4096, 0.18F)), 0.0);
    double sum = 0.0;
    for (const std::uint8_t value : rgb) {
        EXPECT_NEAR(value, expected, 1.0);
        sum += value;
    }
    // the dither keeps the mean: standard error of a fraction's mean over 4096 pixels is below 0.5/64
    EXPECT_NEAR(sum / static_cast<double>(rgb.size()), expected, 4.0 * 0.5 / 64.0);
}

/// Colours that are premultiplied by alpha look as the opaque ones, whatever the alpha.
TEST(ToneMap, AlphaIsTakenOutOfTheColours) {
    const std::vector<float> alphas{1.0F, 0.5F, 0.25F, 0.0F, -1.0F, 2.0F, std::numeric_limits<float>::quiet_NaN()};
    LayeredImage image = greyImage(std::vector<float>(alphas.size(), 0.18F));
    const std::vector<std::uint8_t> opaque = toneMap(image, 0.5);
    for (const char* name : {"R", "G", "B"})
        for (std::size_t i = 0; i < 3; ++i) image.layers[name][i] *= alphas[i];
    image.layer("A") = alphas;
    const std::vector<std::uint8_t> rgba = toneMapWithAlpha(image, Tone{0.5});
    ASSERT_EQ(rgba.size(), 4 * alphas.size());
    const int expected[7] = {255, 128, 64, 0, 0, 255, 0};
    for (std::size_t i = 0; i < alphas.size(); ++i) {
        EXPECT_EQ(rgba[4 * i + 3], expected[i]) << i;
        for (std::size_t c = 0; c < 3; ++c) {
            if (i < 3) {
                EXPECT_EQ(rgba[4 * i + c], opaque[3 * i + c]) << i;
            }
            if (expected[i] == 0) {
                EXPECT_EQ(rgba[4 * i + c], 0) << i;
            }
        }
    }
}

TEST(ToneMap, ExposureIsInStops) {
    EXPECT_EQ(toneMap(greyImage({0.1F, 0.7F}), 2.0), toneMap(greyImage({0.4F, 2.8F}), 0.0));
}

TEST(ToneMap, NothingButNumbersComesOut) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::uint8_t> rgb =
        toneMap(greyImage({nan, inf, -inf, -1.0F, 0.0F, std::numeric_limits<float>::max()}), 64.0);
    EXPECT_EQ(rgb, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255}));
}

}  // namespace
}  // namespace lumulus
