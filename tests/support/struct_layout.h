#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumulus::test {

struct MemberLayout {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;  ///< 0 for an array without a size

    bool operator==(const MemberLayout&) const = default;
};

/// How a struct of a shader lies in memory, to be compared with sizeof and offsetof.
struct StructLayout {
    std::string name;
    std::uint64_t bytes = 0;  ///< rounded up to the alignment of the largest scalar in it, as sizeof is
    std::vector<MemberLayout> members;
};

/// The struct or block of that type name, as the SPIR-V says that it lies in a storage buffer or in push constants.
/// Throws std::logic_error where neither has it.
StructLayout structLayout(std::span<const std::uint32_t> spirv, std::string_view name);

}  // namespace lumulus::test
