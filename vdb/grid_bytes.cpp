#include "vdb/grid_bytes.h"

#include <fmt/format.h>
#include <openvdb/io/Stream.h>

#include <cstdint>
#include <sstream>
#include <string_view>
#include <utility>

namespace lumulus::vdb {
namespace {

/// FNV-1a (Fowler, Noll, Vo), 64 bits.
std::uint64_t hashOf(std::string_view bytes, std::uint64_t hash) {
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
    return hash;
}

/// Replaces the random UUID that OpenVDB gives each file by one from the content (RFC 9562, version 8), so that equal
/// clouds give equal bytes.
void setContentUuid(std::string& file) {
    constexpr std::size_t start = 21;   // after the magic number, three versions and a flag
    constexpr std::size_t length = 36;  // in text
    const std::string_view content = std::string_view(file).substr(start + length);
    std::uint64_t high = hashOf(content, 0xCBF29CE484222325U);
    std::uint64_t low = hashOf(content, high);
    high = (high & 0xFFFFFFFFFFFF0FFFU) | 0x8000U;
    low = (low >> 2U) | 0x8000000000000000U;
    file.replace(start, length,
                 fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32U, (high >> 16U) & 0xFFFFU,
                             high & 0xFFFFU, low >> 48U, low & 0xFFFFFFFFFFFFU));
}

}  // namespace

std::string bytesOf(const openvdb::GridCPtrVec& grids) {
    std::ostringstream out(std::ios::binary);
    out.exceptions(std::ios::badbit | std::ios::failbit);
    openvdb::io::Stream(out).write(grids);
    std::string bytes = std::move(out).str();
    setContentUuid(bytes);
    return bytes;
}

}  // namespace lumulus::vdb
