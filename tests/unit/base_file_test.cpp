#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <span>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "support/temporary_folder.h"

namespace lumulus {
namespace {

namespace fs = std::filesystem;
using test::readAll;
using test::TemporaryFolder;

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text));
}

/// Limits the size of files that this process may write, as a full disk would.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &old_); }

  private:
    rlimit old_{};
};

TEST(AtomicFile, WritesAndReplaces) {
    const TemporaryFolder folder;
    writeFile(folder / "a.bin", bytesOf("first"));
    EXPECT_EQ(readAll(folder / "a.bin"), "first");
    writeFile(folder / "a.bin", bytesOf(std::string("se\0cond", 7)));
    EXPECT_EQ(readAll(folder / "a.bin"), std::string("se\0cond", 7));
    writeFile(folder / "empty", {});
    EXPECT_TRUE(fs::exists(folder / "empty"));
    EXPECT_EQ(folder.files(), 2U);
}

TEST(AtomicFile, TwoFilesOfOneFolderDoNotShareTheTemporary) {
    const TemporaryFolder folder;
    // what a killed process with this number would have left behind
    test::writeAll(folder / (".lumulus-" + std::to_string(::getpid()) + "-0.tmp"), "left behind");
    writeFile(folder / "a", bytesOf("text"));
    EXPECT_EQ(readAll(folder / "a"), "text");
    EXPECT_EQ(folder.files(), 2U);
}

TEST(AtomicFile, FollowsLinks) {
    const TemporaryFolder folder;
    test::writeAll(folder / "target", "old");
    fs::create_symlink("target", folder / "link");
    writeFile(folder / "link", bytesOf("new"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(readAll(folder / "target"), "new");
}

TEST(AtomicFile, MakesTheTargetOfADanglingLink) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "store");
    fs::create_symlink("store/new", folder / "relative");
    fs::create_symlink(folder / "relative", folder / "chain");
    checkWritable(folder / "chain");
    EXPECT_FALSE(fs::exists(folder / "store/new"));
    writeFile(folder / "chain", bytesOf("text"));
    EXPECT_TRUE(fs::is_symlink(folder / "chain"));
    EXPECT_TRUE(fs::is_symlink(folder / "relative"));
    EXPECT_EQ(readAll(folder / "store/new"), "text");
    fs::create_symlink("loop", folder / "loop");
    EXPECT_THROW(writeFile(folder / "loop", bytesOf("text")), InputError);
    fs::create_symlink("missing/new", folder / "nowhere");
    EXPECT_THROW(checkWritable(folder / "nowhere"), InputError);
}

TEST(AtomicFile, KeepsPermissions) {
    const TemporaryFolder folder;
    for (const unsigned mode : {0640U, 0600U, 0666U, 0755U}) {
        test::writeAll(folder / "a", "old");
        fs::permissions(folder / "a", fs::perms(mode));
        writeFile(folder / "a", bytesOf("new"));
        EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "a").permissions()), mode);
        EXPECT_EQ(readAll(folder / "a"), "new");
    }
}

TEST(AtomicFile, RefusesFilesThatMayNotBeWritten) {
    const TemporaryFolder folder;
    test::writeAll(folder / "a", "old");
    fs::create_symlink("a", folder / "link");
    fs::permissions(folder / "a", fs::perms(0444));
    for (const char* name : {"a", "link"}) {
        EXPECT_THROW(checkWritable(folder / name), InputError);
        EXPECT_THROW(writeFile(folder / name, bytesOf("new")), InputError);
    }
    EXPECT_EQ(readAll(folder / "a"), "old");
}

TEST(AtomicFile, NamesOfOneFileAreEqual) {
    const TemporaryFolder folder;
    fs::create_symlink("a", folder / "link");
    fs::create_symlink(".", folder / "here");
    const fs::path file = outputFile(folder / "a");
    EXPECT_EQ(outputFile(folder / "./a"), file);
    EXPECT_EQ(outputFile(folder / "link"), file);
    EXPECT_EQ(outputFile(folder / "here/a"), file);
    EXPECT_NE(outputFile(folder / "b"), file);
    // names from the working folder, of a file that is not there yet
    EXPECT_EQ(outputFile("no-such-file"), outputFile("./no-such-file"));
    EXPECT_EQ(outputFile("no-such-file"), outputFile(fs::current_path() / "no-such-file"));
}

TEST(AtomicFile, BadPlacesAreBadInput) {
    const TemporaryFolder folder;
    test::writeAll(folder / "file", "");
    for (const fs::path& place : {folder / "missing/a", folder.path(), folder / "file/a", fs::path()}) {
        EXPECT_THROW(writeFile(place, bytesOf("x")), InputError) << place;
        EXPECT_THROW(checkWritable(place), InputError) << place;
    }
    EXPECT_EQ(folder.files(), 1U);
}

TEST(AtomicFile, NoPermissionIsBadInput) {
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms(0555));
    // in a process of its own, which gives up the rights of root where it has them
    EXPECT_EXIT(
        {
            if (::geteuid() == 0 && ::seteuid(65534) != 0) std::_Exit(9);
            try {
                writeFile(folder / "a", bytesOf("text"));
            } catch (const InputError&) {
                std::_Exit(7);
            }
            std::_Exit(8);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(folder.files(), 0U);
}

TEST(AtomicFile, CheckLeavesNothing) {
    const TemporaryFolder folder;
    test::writeAll(folder / "old", "old");
    checkWritable(folder / "old");
    checkWritable(folder / "new");
    EXPECT_EQ(readAll(folder / "old"), "old");
    EXPECT_EQ(folder.files(), 1U);
}

TEST(AtomicFile, FullDeviceFailsAndStaysADevice) {
    try {
        writeFile("/dev/full", bytesOf("text"));
        FAIL() << "a full device must fail";
    } catch (const InputError&) {
        FAIL() << "a full disk is no bad input";
    } catch (const Error& e) {
        EXPECT_EQ(e.exitCode(), 1);
        EXPECT_NE(std::string(e.what()).find("/dev/full"), std::string::npos);
    }
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
    EXPECT_NO_THROW(writeFile("/dev/null", bytesOf("text")));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

/// /dev/stdout of a pipeline and the >(…) of shells are links to a pipe that has no name.
TEST(AtomicFile, WritesIntoPipes) {
    installSignalHandlers();  // SIGPIPE would kill the process
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const fs::path name = "/dev/fd/" + std::to_string(ends[1]);
    checkWritable(name);
    writeFile(name, bytesOf("text"));
    char read[5] = {};
    EXPECT_EQ(::read(ends[0], read, 4), 4);
    EXPECT_STREQ(read, "text");
    ::close(ends[0]);
    EXPECT_NO_THROW(writeFile("/proc/self/fd/" + std::to_string(ends[1]), bytesOf("text")));
    ::close(ends[1]);
}

TEST(AtomicFile, FullDiskKeepsTheOldFileAndNoTemporary) {
    installSignalHandlers();  // SIGXFSZ would kill the process
    const TemporaryFolder folder;
    writeFile(folder / "a", bytesOf("old"));
    {
        const FileSizeLimit limit(1000);
        EXPECT_THROW(writeFile(folder / "a", bytesOf(std::string(100000, 'x'))), Error);
    }
    EXPECT_EQ(readAll(folder / "a"), "old");
    EXPECT_EQ(folder.files(), 1U);
}

TEST(Interrupt, SignalSetsTheFlag) {
    // in a process of its own: the flag never falls back
    EXPECT_EXIT(
        {
            installSignalHandlers();
            const bool before = interrupted();
            std::raise(SIGINT);
            std::_Exit(!before && interrupted() ? 7 : 8);
        },
        testing::ExitedWithCode(7), "");
}

TEST(Interrupt, SecondSignalEndsTheProcess) {
    EXPECT_EXIT(
        {
            installSignalHandlers();
            std::raise(SIGTERM);
            std::raise(SIGTERM);
            std::_Exit(0);
        },
        testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace lumulus
