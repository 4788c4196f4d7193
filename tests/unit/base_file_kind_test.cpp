// Files of other kinds are named as what they are.
#include <gtest/gtest.h>

#include "base/file_kind.h"
#include "support/temporary_folder.h"

namespace lumulus {
namespace {

std::string_view nameOf(const std::string& start) {
    const auto foreign = foreignFile(start);
    return foreign ? foreign->name : "";
}

TEST(FileKind, NamesWhatPeopleGiveByMistake) {
    EXPECT_EQ(nameOf("\x1f\x8b\x08 and more"), "a gzip archive");
    EXPECT_EQ(nameOf("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 3\n"),
              "a pointer of Git LFS, not the file itself");
    EXPECT_EQ(nameOf("PK\x03\x04"), "a ZIP archive");
    EXPECT_EQ(nameOf("\x89HDF\r\n\x1a\n"), "an HDF5 file");
    EXPECT_EQ(nameOf("<!DOCTYPE html>"), "a web page");
    EXPECT_EQ(nameOf(std::string(257, '\0') + "ustar\0"), "a tar archive");
}

TEST(FileKind, OthersAreNotForeign) {
    EXPECT_EQ(nameOf(""), "");
    EXPECT_EQ(nameOf("[image]\nwidth = 3\n"), "");
    EXPECT_EQ(nameOf("version = 3"), "");
    EXPECT_TRUE(isOpenVdb(std::string(" BDV\0\0\0\0rest", 12)));
    EXPECT_FALSE(isOpenVdb(" BDV"));
    EXPECT_TRUE(isNanoVdb("NanoVDB0"));
    EXPECT_TRUE(isNanoVdb("NanoVDB2"));
}

TEST(FileKind, StartsOfFilesAlone) {
    const test::TemporaryFolder folder;
    test::writeAll(folder / "a", "abc");
    EXPECT_EQ(fileStart(folder / "a"), "abc");
    test::writeAll(folder / "b", std::string(2000, 'x'));
    EXPECT_EQ(fileStart(folder / "b").size(), fileStartBytes);
    EXPECT_EQ(fileStart(folder / "absent"), "");
    EXPECT_EQ(fileStart(folder.path()), "");
    EXPECT_EQ(fileStart("/dev/zero"), "");
}

}  // namespace
}  // namespace lumulus
