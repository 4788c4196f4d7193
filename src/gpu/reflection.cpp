#include "gpu/reflection.h"

#include <fmt/format.h>
#include <spirv_cross_c.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

using SpirvContext = std::unique_ptr<spvc_context_s, decltype(&spvc_context_destroy)>;

void require(bool holds, const std::string& what) {
    if (!holds) {
        throw std::logic_error("SPIR-V reflection: " + what);
    }
}

/// One shader being read.
class Reader {
  public:
    explicit Reader(std::span<const std::uint32_t> spirv) : context_(makeContext()) {
        spvc_parsed_ir parsed = nullptr;
        call(spvc_context_parse_spirv(context_.get(), spirv.data(), spirv.size(), &parsed));
        call(spvc_context_create_compiler(context_.get(), SPVC_BACKEND_NONE, parsed, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                          &compiler_));
        call(spvc_compiler_create_shader_resources(compiler_, &resources_));
    }

    Reflection read() {
        for (const auto type : {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, SPVC_RESOURCE_TYPE_SEPARATE_IMAGE,
                                SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE}) {
            require(list(type).empty(), "uniform blocks and separate samplers are not used here");
        }
        for (const spvc_reflected_resource& resource : list(SPVC_RESOURCE_TYPE_STORAGE_BUFFER)) {
            readBuffer(resource);
        }
        for (const spvc_reflected_resource& resource : list(SPVC_RESOURCE_TYPE_STORAGE_IMAGE)) {
            BindingInfo info = readBinding(resource, BindingKind::storageImage);
            info.reads = spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationNonReadable) == SPVC_FALSE;
            info.writes = spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationNonWritable) == SPVC_FALSE;
            result_.bindings.push_back(info);
        }
        for (const spvc_reflected_resource& resource : list(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE)) {
            result_.bindings.push_back(readBinding(resource, BindingKind::sampledImage));
        }
        for (const spvc_reflected_resource& resource : list(SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
            readStruct(resource.base_type_id);
            result_.pushBytes = result_.layout(typeName(resource.base_type_id)).bytes;
        }
        std::sort(result_.bindings.begin(), result_.bindings.end(),
                  [](const BindingInfo& a, const BindingInfo& b) { return a.binding < b.binding; });
        readConstants();
        return std::move(result_);
    }

  private:
    static SpirvContext makeContext() {
        spvc_context context = nullptr;
        require(spvc_context_create(&context) == SPVC_SUCCESS, "no context");
        return {context, &spvc_context_destroy};
    }

    void call(spvc_result result) const {
        require(result == SPVC_SUCCESS, spvc_context_get_last_error_string(context_.get()));
    }

    std::span<const spvc_reflected_resource> list(spvc_resource_type type) const {
        const spvc_reflected_resource* first = nullptr;
        std::size_t count = 0;
        call(spvc_resources_get_resource_list_for_type(resources_, type, &first, &count));
        return {first, count};
    }

    std::string typeName(spvc_type_id id) const { return spvc_compiler_get_name(compiler_, id); }

    BindingInfo readBinding(const spvc_reflected_resource& resource, BindingKind kind) const {
        BindingInfo info;
        info.name = spvc_compiler_get_name(compiler_, resource.id);
        if (info.name.empty()) {
            info.name = typeName(resource.base_type_id);
        }
        info.kind = kind;
        info.binding = spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationBinding);
        require(spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationDescriptorSet) == 0,
                info.name + " is not in descriptor set 0");
        spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.type_id);
        require(spvc_type_get_num_array_dimensions(type) == 0, info.name + " is an array of resources");
        if (kind != BindingKind::storageBuffer) {
            const SpvDim dimension = spvc_type_get_image_dimension(type);
            require(dimension == SpvDim2D || dimension == SpvDim3D, info.name + " is neither a 2D nor a 3D image");
            info.dimensions = dimension == SpvDim3D ? 3 : 2;
        }
        return info;
    }

    void readBuffer(const spvc_reflected_resource& resource) {
        BindingInfo info = readBinding(resource, BindingKind::storageBuffer);
        const SpvDecoration* first = nullptr;
        std::size_t count = 0;
        call(spvc_compiler_get_buffer_block_decorations(compiler_, resource.id, &first, &count));
        // the qualifiers stand on the members; these are the ones that all members have
        const std::span decorations(first, count);
        info.reads = std::find(decorations.begin(), decorations.end(), SpvDecorationNonReadable) == decorations.end();
        info.writes = std::find(decorations.begin(), decorations.end(), SpvDecorationNonWritable) == decorations.end();
        result_.bindings.push_back(info);
        readStruct(resource.base_type_id);
    }

    /// Adds the struct and those nested in it; returns the alignment in scalar layout.
    std::uint64_t readStruct(spvc_type_id id) {
        StructLayout layout;
        layout.name = typeName(id);
        spvc_type type = spvc_compiler_get_type_handle(compiler_, id);
        std::uint64_t alignment = 1;
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
            spvc_type member = spvc_compiler_get_type_handle(compiler_, spvc_type_get_member_type(type, i));
            alignment = std::max(alignment, spvc_type_get_basetype(member) == SPVC_BASETYPE_STRUCT
                                                ? readStruct(spvc_type_get_base_type_id(member))
                                                : spvc_type_get_bit_width(member) / 8);
            unsigned offset = 0;
            std::size_t bytes = 0;
            call(spvc_compiler_type_struct_member_offset(compiler_, type, i, &offset));
            call(spvc_compiler_get_declared_struct_member_size(compiler_, type, i, &bytes));
            layout.members.push_back({spvc_compiler_get_member_name(compiler_, id, i), offset, bytes});
        }
        const MemberLayout& last = layout.members.back();
        layout.bytes = (last.offset + last.bytes + alignment - 1) / alignment * alignment;
        const auto& known = result_.structs;
        if (std::none_of(known.begin(), known.end(), [&](auto& other) { return other.name == layout.name; })) {
            result_.structs.push_back(std::move(layout));
        }
        return alignment;
    }

    void readConstants() {
        const spvc_specialization_constant* first = nullptr;
        std::size_t count = 0;
        call(spvc_compiler_get_specialization_constants(compiler_, &first, &count));
        for (const spvc_specialization_constant& constant : std::span(first, count)) {
            result_.constantIds.push_back(constant.constant_id);
        }
        spvc_specialization_constant sizes[3] = {};
        spvc_compiler_get_work_group_size_specialization_constants(compiler_, &sizes[0], &sizes[1], &sizes[2]);
        for (unsigned axis = 0; axis < 3; ++axis) {
            result_.workgroup[static_cast<int>(axis)] =
                spvc_compiler_get_execution_mode_argument_by_index(compiler_, SpvExecutionModeLocalSize, axis);
            if (sizes[axis].id != 0) {
                result_.workgroupId[axis] = sizes[axis].constant_id;
                spvc_constant value = spvc_compiler_get_constant_handle(compiler_, sizes[axis].id);
                result_.workgroup[static_cast<int>(axis)] = spvc_constant_get_scalar_u32(value, 0, 0);
            }
        }
    }

    SpirvContext context_;
    spvc_compiler compiler_ = nullptr;  // owned by the context, as are the resources
    spvc_resources resources_ = nullptr;
    Reflection result_;
};

}  // namespace

const StructLayout& Reflection::layout(std::string_view name) const {
    const auto found = std::find_if(structs.begin(), structs.end(), [&](const auto& s) { return s.name == name; });
    require(found != structs.end(), fmt::format("no struct {}", name));
    return *found;
}

Reflection reflect(std::span<const std::uint32_t> spirv) {
    return Reader(spirv).read();
}

}  // namespace lumulus::gpu
