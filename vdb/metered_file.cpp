#include "vdb/metered_file.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lumulus::vdb {
namespace {

/// Whether a piece of this length is a mask of a node: one bit for each of 8³, 16³ or 32³ children.
bool isMask(std::streamsize bytes) {
    return bytes == 64 || bytes == 512 || bytes == 4096;
}

/// Memory of a node for each byte of its masks: four bytes of a leaf's value for a bit of its one mask; eight of a
/// pointer or value for the two bits in the masks of a node above.
constexpr std::uint64_t bytesOfMask = 32;
/// The same of a leaf without values: its head.
constexpr std::uint64_t bytesOfHead = 2;
constexpr std::streamsize leafMask = 64;

}  // namespace

MeteredFile::MeteredFile(const std::filesystem::path& path, const ReadLimits& limits) : path_(path), limits_(limits) {
    open(path, std::ios::in | std::ios::binary);
}

void MeteredFile::foresee(std::uint64_t bytes) {
    constexpr double bytesPerMiB = 1048576.0;
    foreseen_ += bytes;
    if (static_cast<double>(foreseen_) <= limits_.treeMiB * bytesPerMiB) return;
    throw InputError(fmt::format("the grid takes more than {:g} MiB while it is read", limits_.treeMiB), path_.string(),
                     "give it fewer voxels, divide it, or raise preparation.memory_budget");
}

void MeteredFile::rethrow() const {
    if (stopped_) std::rethrow_exception(stopped_);
}

/// Tiles are three coordinates, a value and a flag; where a value is a bool, that is a flag too. What follows three
/// coordinates otherwise are masks of a node.
void MeteredFile::checkTile(const char* read, std::streamsize bytes) {
    constexpr std::streamsize coordinates = 3 * sizeof(std::int32_t);
    const bool isFlag = bytes == 1 && (*read == 0 || *read == 1);
    if (tile_.has == Tile::value && bytes == 1) {
        const bool fits = isFlag && (!tile_.isByte || tile_.isFlag);
        tile_ = {};
        if (!fits)
            throw InputError("the file is damaged: a tile is neither active nor inactive", path_.string(),
                             "write it again");
    } else if (tile_.has == Tile::coordinates && !isMask(bytes)) {
        tile_ = {Tile::value, isFlag, bytes == 1};
    } else {
        tile_ = {};
        if (bytes == coordinates) tile_.has = Tile::coordinates;
    }
}

// The stream above may hide what is thrown here behind an error of its own.
std::streamsize MeteredFile::xsgetn(char* to, std::streamsize bytes) {
    std::streamsize read = 0;
    try {
        limits_.check();
        const bool head = bytes == leafMask && leaves_ == Leaves::withoutValues;
        if (counting_ && isMask(bytes)) foresee((head ? bytesOfHead : bytesOfMask) * static_cast<std::uint64_t>(bytes));
        read = std::filebuf::xsgetn(to, bytes);
        if (counting_ && read == bytes) checkTile(to, bytes);
    } catch (...) {
        stopped_ = std::current_exception();
        throw;
    }
    return read;
}

}  // namespace lumulus::vdb
