#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace lumulus {
namespace {

namespace fs = std::filesystem;

std::string errnoText(int code) {
    return std::generic_category().message(code);
}

/// A file descriptor that closes itself.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    int get() const { return fd_; }
    /// Closes the file. Returns false where the kernel lost data: network file systems report a full disk only here.
    bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

  private:
    int fd_;
};

/// A new file beside `target` that removes itself unless it was renamed.
class Temporary {
  public:
    explicit Temporary(const fs::path& target) : fd_(-1) {
        const fs::path directory = target.parent_path();
        struct stat old {};
        const bool replaces = ::stat(target.c_str(), &old) == 0;
        for (int attempt = 0;; ++attempt) {
            path_ = directory / (".lumulus-" + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp");
            // nobody who may not read the old file may read the new one, not even while it is written
            fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, replaces ? 0600 : 0666);
            if (fd_ >= 0) {
                if (replaces) takeOver(old);
                return;
            }
            if (errno != EEXIST) {
                throw InputError("cannot write there: " + errnoText(errno), target.string(),
                                 "choose a folder that can be written to");
            }
        }
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }

    Descriptor takeDescriptor() { return Descriptor(std::exchange(fd_, -1)); }
    void closeUnused() { takeDescriptor(); }
    bool renameTo(const fs::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) return false;
        path_.clear();
        return true;
    }

  private:
    /// Gives the new file the owner and the permissions of the old one. The owner stays another where the system does
    /// not allow the change; the permissions are set last, since a change of the owner may clear some.
    void takeOver(const struct stat& old) const {
        constexpr auto sameOwner = static_cast<uid_t>(-1);
        const bool kept = ::fchown(fd_, old.st_uid, old.st_gid) == 0 || ::fchown(fd_, sameOwner, old.st_gid) == 0;
        static_cast<void>(kept);
        ::fchmod(fd_, old.st_mode & 0777U);
    }

    fs::path path_;
    int fd_;
};

[[noreturn]] void failWrite(const fs::path& path, int code) {
    throw Error("cannot write the file: " + errnoText(code), path.string(), "free some space or choose another place");
}

void writeAll(const Descriptor& file, std::span<const std::byte> bytes, const fs::path& path) {
    while (!bytes.empty()) {
        // write() moves at most 2^31 bytes at once
        const std::size_t chunk = std::min<std::size_t>(bytes.size(), std::size_t{1} << 30);
        const ::ssize_t written = ::write(file.get(), bytes.data(), chunk);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0 && errno == EPIPE) return;  // the reader of the pipe has read enough
        if (written < 0) failWrite(path, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

bool isSpecial(const fs::path& path) {
    std::error_code ec;
    return fs::exists(path, ec) && !fs::is_regular_file(path, ec);
}

/// The file that a path leads to when its symbolic links are followed, also one that does not exist yet.
fs::path followed(const fs::path& path) {
    constexpr int mostLinks = 40;  // as Linux follows
    fs::path target = path;
    std::error_code ec;
    for (int links = 0; fs::is_symlink(target, ec); ++links) {
        const fs::path next = fs::read_symlink(target, ec);
        if (ec || links == mostLinks) {
            throw InputError("cannot follow the link: " + (ec ? ec.message() : "it leads to itself"), path.string(),
                             "give another name");
        }
        target = target.parent_path() / next;  // an absolute one replaces the folder
    }
    return target;
}

/// Refuses a file that is there and may not be written. A file without any permission to write is refused for root too,
/// who could write it: whoever took the permission away meant to keep the file.
void requireWritable(const fs::path& target, const fs::path& path) {
    struct stat found {};
    if (::stat(target.c_str(), &found) != 0) return;
    const bool locked = (found.st_mode & 0222U) == 0;
    if (!locked && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) == 0) return;
    const int reason = !locked && errno == EROFS ? EROFS : EACCES;
    throw InputError("cannot write there: " + errnoText(reason), path.string(),
                     reason == EROFS ? "choose another place" : "allow it (chmod u+w), or give another name");
}

/// The file that `path` stands for, with its links followed. Its folder exists, and it may be written.
fs::path resolve(const fs::path& path) {
    std::error_code ec;
    if (path.empty()) throw InputError("the output has no name", "", "give a file name");
    if (fs::is_directory(path, ec)) {
        throw InputError("cannot write there: it is a folder", path.string(), "give the name of a file");
    }
    // the links of /dev/stdout and /dev/fd to a pipe lead to no name
    const fs::path target = isSpecial(path) ? path : followed(path);
    const fs::path parent = target.has_parent_path() ? target.parent_path() : fs::path(".");
    const fs::file_status status = fs::status(parent, ec);
    if (status.type() == fs::file_type::not_found) {
        throw InputError("cannot write there: the folder does not exist", path.string(),
                         "make the folder first: mkdir -p " + parent.string());
    }
    if (!fs::is_directory(status)) {
        throw InputError("cannot write there: " + (ec ? ec.message() : parent.string() + " is not a folder"),
                         path.string(), "choose another place");
    }
    requireWritable(target, path);
    return parent / target.filename();
}

Descriptor openSpecial(const fs::path& path) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (file.get() < 0) {
        throw InputError("cannot write there: " + errnoText(errno), path.string(), "choose another place");
    }
    return file;
}

}  // namespace

void writeFile(const fs::path& path, std::span<const std::byte> bytes) {
    const fs::path target = resolve(path);
    if (isSpecial(target)) {
        Descriptor file = openSpecial(target);
        writeAll(file, bytes, path);
        if (!file.close()) failWrite(path, errno);
        return;
    }
    Temporary temporary(target);
    Descriptor file = temporary.takeDescriptor();
    writeAll(file, bytes, path);
    if (::fsync(file.get()) != 0 || !file.close() || !temporary.renameTo(target)) failWrite(path, errno);
    // the new name is durable once its folder is synchronised; a file system that cannot do this has lost nothing yet
    const Descriptor folder(::open(target.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.get() >= 0) ::fsync(folder.get());
}

fs::path outputFile(const fs::path& path) {
    const fs::path target = resolve(path);
    std::error_code ec;
    const fs::path folder = fs::canonical(target.parent_path(), ec);
    return (ec ? fs::absolute(target.parent_path()).lexically_normal() : folder) / target.filename();
}

void checkWritable(const fs::path& path) {
    const fs::path target = resolve(path);
    // a pipe is not opened for the test: its reader would take the closing for the end
    if (!isSpecial(target)) Temporary(target).closeUnused();
}

}  // namespace lumulus
