// Headers that claim more than their files can hold are refused before memory is taken.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/exr.h"
#include "support/temporary_folder.h"

namespace lumulus {
namespace {

using ::testing::HasSubstr;

constexpr int compressions = Imf::NUM_COMPRESSION_METHODS;

class ExrClaims : public ::testing::Test {
  protected:
    std::filesystem::path file() const { return folder_ / "a.exr"; }

    /// Writes a picture of one channel that is 0.5 everywhere, which every compression packs closest.
    void write(int width, int height, Imf::Compression compression, Imf::PixelType type = Imf::FLOAT) const {
        Imf::Header header(width, height);
        header.compression() = compression;
        header.channels().insert("R", Imf::Channel(type));
        const std::vector<float> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.5F);
        const std::vector<Imath::half> halves(values.begin(), values.end());
        const void* data = type == Imf::FLOAT ? static_cast<const void*>(values.data()) : halves.data();
        const std::size_t bytes = type == Imf::FLOAT ? 4 : 2;
        Imf::FrameBuffer frame;
        frame.insert("R",
                     Imf::Slice::Make(type, data, header.dataWindow(), bytes, bytes * static_cast<std::size_t>(width)));
        Imf::OutputFile out(file().c_str(), header);
        out.setFrameBuffer(frame);
        out.writePixels(height);
    }

    /// Replaces the value of an attribute from the byte `at` on.
    void claim(const std::string& nameAndType, std::size_t at, std::initializer_list<std::int32_t> values) const {
        std::string bytes = test::readAll(file());
        const std::size_t found = bytes.find(nameAndType);
        ASSERT_NE(found, std::string::npos);
        std::memcpy(&bytes[found + nameAndType.size() + 4 + at], values.begin(), values.size() * 4);
        test::writeAll(file(), bytes);
    }

    std::string refusal() const {
        try {
            readExr(file());
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

  private:
    test::TemporaryFolder folder_;
};

const std::string windowAttribute("dataWindow\0box2i\0", 17);
const std::string tilesAttribute("tiles\0tiledesc\0", 15);

TEST_F(ExrClaims, ThousandMillionPixelsASide) {
    for (int compression = 0; compression < compressions; ++compression) {
        write(4, 4, static_cast<Imf::Compression>(compression));
        claim(windowAttribute, 8, {999999999, 999999999});
        EXPECT_THAT(refusal(), HasSubstr(file().string())) << compression;
    }
}

TEST_F(ExrClaims, WidthOrHeightAlone) {
    for (int compression = 0; compression < compressions; ++compression)
        for (const auto& corner : {std::pair{99999999, 3}, {3, 99999999}}) {
            write(4, 4, static_cast<Imf::Compression>(compression));
            claim(windowAttribute, 8, {corner.first, corner.second});
            EXPECT_THAT(refusal(), HasSubstr("than the file can hold")) << compression;
        }
}

TEST_F(ExrClaims, WindowsAtTheEndsOfIntegers) {
    write(4, 4, Imf::ZIP_COMPRESSION);
    constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t highest = std::numeric_limits<std::int32_t>::max();
    claim(windowAttribute, 0, {lowest, lowest, highest, highest});
    EXPECT_NE(refusal(), "");
    claim(windowAttribute, 0, {highest, highest, lowest, lowest});
    EXPECT_NE(refusal(), "");
}

TEST_F(ExrClaims, FlatPicturesOfEveryCompressionAreRead) {
    // more than the 16 MiB that are always allowed, packed as close as each compression does
    for (int compression = 0; compression < compressions; ++compression) {
        write(2048, 2100, static_cast<Imf::Compression>(compression));
        EXPECT_EQ(refusal(), "") << compression;
    }
    write(2048, 4200, Imf::B44A_COMPRESSION, Imf::HALF);
    EXPECT_EQ(refusal(), "");
    write(2048, 4200, Imf::DWAB_COMPRESSION, Imf::HALF);
    EXPECT_EQ(refusal(), "");
    EXPECT_LT(std::filesystem::file_size(file()), 50'000U);
}

TEST_F(ExrClaims, HugeTiles) {
    {
        Imf::Header header(4, 4);
        header.setTileDescription(Imf::TileDescription(32, 32, Imf::ONE_LEVEL));
        header.channels().insert("R", Imf::Channel(Imf::HALF));
        const std::vector<Imath::half> values(16, 0.5F);
        Imf::TiledOutputFile out(file().c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("R", Imf::Slice::Make(Imf::HALF, values.data(), header.dataWindow()));
        out.setFrameBuffer(frame);
        out.writeTile(0, 0);
    }
    EXPECT_EQ(refusal(), "");
    claim(tilesAttribute, 0, {30000, 30000});
    EXPECT_THAT(refusal(), HasSubstr("1800000000 bytes, more than the file can hold"));
}

TEST_F(ExrClaims, WideBlocksOfRows) {
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::B44_COMPRESSION}) {
        write(4, 1, compression);
        claim(windowAttribute, 8, {4'000'000, 0});  // 16 MB of pixels, but OpenEXR takes memory for 16 or 32 rows
        EXPECT_THAT(refusal(), HasSubstr("blocks of rows")) << compression;
    }
}

TEST_F(ExrClaims, AttributesLongerThanTheFile) {
    for (const std::int32_t bytes : {1885430528, std::numeric_limits<std::int32_t>::max(), -1}) {
        write(4, 4, Imf::NO_COMPRESSION);
        std::string text = test::readAll(file());
        const std::string attribute("owner\0string\0", 13);
        text.insert(8, attribute + std::string(reinterpret_cast<const char*>(&bytes), 4) + "me");
        test::writeAll(file(), text);
        EXPECT_NE(refusal(), "") << bytes;
    }
    write(4, 4, Imf::NO_COMPRESSION);
    EXPECT_EQ(refusal(), "");
}

// OpenEXR would go on within the list, where 2 GB are claimed (found by the fuzz target exr)
TEST_F(ExrClaims, ListOfChannelsLongerThanItsChannels) {
    write(4, 4, Imf::NO_COMPRESSION);
    std::string text = test::readAll(file());
    const std::string attribute("channels\0chlist\0", 16), claim("x\0y\0\x10\0\0\x76", 8);
    const std::size_t length = text.find(attribute) + attribute.size();
    constexpr std::size_t whole = 19;  // one channel and the empty name
    ASSERT_EQ(text[length], static_cast<char>(whole));
    text[length] = static_cast<char>(whole + claim.size());
    text.insert(length + 4 + whole, claim);
    test::writeAll(file(), text);
    EXPECT_THAT(refusal(), HasSubstr("list of channels"));
}

// The same behind a value of fixed size that is said to be shorter
TEST_F(ExrClaims, ValuesOfOtherSizesThanTheirTypes) {
    const std::vector<std::string> attributes{
        {"screenWindowCenter\0v2f\0", 23}, {"dataWindow\0box2i\0", 17}, {"compression\0compression\0", 24}};
    for (const std::string& attribute : attributes)
        for (const int more : {-1, 1}) {
            write(4, 4, Imf::NO_COMPRESSION);
            std::string text = test::readAll(file());
            const std::size_t length = text.find(attribute) + attribute.size();
            text[length] = static_cast<char>(text[length] + more);
            if (more > 0) text.insert(length + 4, "x");
            if (more < 0) text.erase(length + 4, 1);
            test::writeAll(file(), text);
            EXPECT_NE(refusal(), "") << attribute << more;
        }
    write(4, 4, Imf::NO_COMPRESSION);
    std::string text = test::readAll(file());
    const std::string attribute("screenWindowCenter\0v2f\0", 23);
    text[text.find(attribute) + attribute.size()] = 2;
    test::writeAll(file(), text);
    EXPECT_THAT(refusal(), HasSubstr("of the type v2f claims 2 bytes"));
}

// OpenEXR names an attribute as the file does (found by the fuzz target exr)
TEST_F(ExrClaims, NamesOfSeveralLines) {
    write(4, 4, Imf::NO_COMPRESSION);
    std::string text = test::readAll(file());
    text.insert(8, std::string("a\nb\0int\0\4\0\0\0none", 16) + std::string("a\nb\0string\0\4\0\0\0none", 19));
    test::writeAll(file(), text);
    EXPECT_NE(refusal(), "");
    EXPECT_EQ(refusal().find('\n'), std::string::npos) << refusal();
}

TEST_F(ExrClaims, TooManyValues) {
    write(4, 4, Imf::ZIP_COMPRESSION);
    claim(windowAttribute, 8, {32767, 8192});  // 2^28 and one row more
    EXPECT_THAT(refusal(), HasSubstr("than the file can hold"));
    test::writeAll(file(), test::readAll(file()) + std::string(std::size_t{8} << 20U, '\0'));
    EXPECT_THAT(refusal(), HasSubstr("32768 × 8193 pixels is too large to read"));
}

}  // namespace
}  // namespace lumulus
