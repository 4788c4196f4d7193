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

// The stream above may hide what is thrown here behind an error of its own.
std::streamsize MeteredFile::xsgetn(char* to, std::streamsize bytes) {
    try {
        limits_.check();
        const bool head = bytes == leafMask && leaves_ == Leaves::withoutValues;
        if (counting_ && isMask(bytes)) foresee((head ? bytesOfHead : bytesOfMask) * static_cast<std::uint64_t>(bytes));
    } catch (...) {
        stopped_ = std::current_exception();
        throw;
    }
    return std::filebuf::xsgetn(to, bytes);
}

}  // namespace lumulus::vdb
