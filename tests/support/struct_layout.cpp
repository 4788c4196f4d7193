#include "support/struct_layout.h"

#include <algorithm>
#include <spirv_cross.hpp>
#include <stdexcept>

namespace lumulus::test {
namespace {

using spirv_cross::Compiler;

/// Adds the structs nested in it, then the struct (again where bindings share it); returns the alignment in scalar
/// layout.
std::uint64_t readStruct(const Compiler& compiler, spirv_cross::TypeID id, std::vector<StructLayout>& structs) {
    const spirv_cross::SPIRType& type = compiler.get_type(id);
    StructLayout layout{.name = compiler.get_name(id), .bytes = 0, .members = {}};
    std::uint64_t alignment = 1;
    for (std::uint32_t i = 0; i < type.member_types.size(); ++i) {
        const spirv_cross::SPIRType& member = compiler.get_type(type.member_types[i]);
        const bool nested = member.basetype == spirv_cross::SPIRType::Struct;
        alignment =
            std::max(alignment, nested ? readStruct(compiler, member.self, structs) : std::uint64_t{member.width / 8});
        layout.members.push_back({compiler.get_member_name(id, i), compiler.type_struct_member_offset(type, i),
                                  compiler.get_declared_struct_member_size(type, i)});
    }
    const MemberLayout& last = layout.members.back();
    layout.bytes = (last.offset + last.bytes + alignment - 1) / alignment * alignment;
    structs.push_back(std::move(layout));
    return alignment;
}

}  // namespace

StructLayout structLayout(std::span<const std::uint32_t> spirv, std::string_view name) {
    const Compiler compiler(spirv.data(), spirv.size());
    const spirv_cross::ShaderResources resources = compiler.get_shader_resources();
    std::vector<StructLayout> structs;
    for (const auto& buffer : resources.storage_buffers) readStruct(compiler, buffer.base_type_id, structs);
    for (const auto& block : resources.push_constant_buffers) readStruct(compiler, block.base_type_id, structs);
    const auto found = std::ranges::find(structs, name, &StructLayout::name);
    if (found == structs.end()) throw std::logic_error("no struct " + std::string(name));
    return *found;
}

}  // namespace lumulus::test
