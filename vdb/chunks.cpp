#include "vdb/chunks.h"

#include <blosc.h>
#include <openvdb/Exceptions.h>
#include <openvdb/io/Compression.h>
#include <zlib.h>

#include <cstdint>
#include <istream>
#include <memory>

// OpenVDB 10 reads a chunk that was stored as it is before it looks whether the chunk is as long as the node's values
// (io/Compression.cc): a damaged mask or length makes it write beyond its buffer. Later versions look first. The two
// functions of that file are called through the table of dynamic symbols, where those of the program go before those
// of its libraries: the ones below take their place, for all types of grids.
namespace lumulus::vdb {

void guardChunks() {}

namespace {

/// Bytes that a packer may add: blosc's header, the frame of an empty zip.
constexpr std::uint64_t mostOverhead = 64;

[[noreturn]] void refuseChunk() {
    OPENVDB_THROW(openvdb::RuntimeError, "a chunk of values does not have the length of its node");
}

/// Reads a chunk: its length (negative if it is not packed) and that many bytes. `unpack(packed, length)` returns true
/// if it filled the `bytes` of `to`. Without `to` the chunk is skipped.
template <typename Unpack>
void readChunk(std::istream& in, char* to, std::size_t bytes, const Unpack& unpack) {
    std::int64_t stored = 0;
    in.read(reinterpret_cast<char*>(&stored), sizeof(stored));
    const bool packed = stored > 0;
    const std::uint64_t length = packed ? static_cast<std::uint64_t>(stored) : -static_cast<std::uint64_t>(stored);
    if (!packed && length != bytes) refuseChunk();
    // what is longer when packed is stored as it is; so no memory is taken for a length that is only claimed
    if (packed && length > bytes + mostOverhead) refuseChunk();
    if (to == nullptr) {
        in.seekg(static_cast<std::streamoff>(length), std::ios::cur);
    } else if (!packed) {
        in.read(to, static_cast<std::streamsize>(length));
    } else {
        const auto chunk = std::make_unique_for_overwrite<char[]>(length);
        in.read(chunk.get(), static_cast<std::streamsize>(length));
        // versions of the packers differ in how they pack nothing
        if (bytes > 0 && !unpack(chunk.get(), length)) refuseChunk();
    }
}

}  // namespace
}  // namespace lumulus::vdb

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {
namespace io {

void unzipFromStream(std::istream& in, char* to, std::size_t bytes) {
    lumulus::vdb::readChunk(in, to, bytes, [&](const char* packed, std::size_t length) {
        uLongf filled = bytes;
        return uncompress(reinterpret_cast<Bytef*>(to), &filled, reinterpret_cast<const Bytef*>(packed), length) ==
                   Z_OK &&
               filled == bytes;
    });
}

void bloscFromStream(std::istream& in, char* to, std::size_t bytes) {
    lumulus::vdb::readChunk(in, to, bytes, [&](const char* packed, std::size_t length) {
        // blosc believes the lengths in its header, unless it is asked to compare them
        std::size_t unpacked = 0;
        constexpr int threads = 1;
        return blosc_cbuffer_validate(packed, length, &unpacked) == 0 && unpacked == bytes &&
               blosc_decompress_ctx(packed, to, bytes, threads) == static_cast<int>(bytes);
    });
}

}  // namespace io
}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
