#pragma once

#include <bit>
#include <span>

#include "gpu/context.h"
#include "gpu/reflection.h"

namespace lumulus::gpu {

/// A value for `layout(constant_id = id) const`, as bits.
struct SpecConstant {
    std::uint32_t id = 0;
    std::uint32_t value = 0;

    static SpecConstant of(std::uint32_t id, auto value) { return {id, std::bit_cast<std::uint32_t>(value)}; }
    static SpecConstant of(std::uint32_t id, bool value) { return {id, value ? VK_TRUE : VK_FALSE}; }
};

/// The type of a program without push constants.
struct NoPush {};

/// A compute pipeline whose layout comes from its SPIR-V: push descriptors in set 0 and one push-constant block.
/// Programs of the same code and constants share what is compiled.
class ProgramBase {
  public:
    const std::string& name() const { return name_; }
    const std::vector<BindingInfo>& bindings() const { return bindings_; }
    std::uint32_t pushBytes() const { return pushBytes_; }
    VkPipeline pipeline() const { return pipeline_->handle.get(); }
    VkPipelineLayout layout() const { return pipeline_->layout.get(); }

  protected:
    ProgramBase(Context& context, std::string name, std::span<const std::uint32_t> spirv,
                const std::vector<SpecConstant>& constants, std::uint32_t pushBytes, std::uint32_t pushAlignment);

  private:
    void createLayout(Context& context);
    void createPipeline(Context& context, std::span<const std::uint32_t> spirv,
                        const std::vector<SpecConstant>& constants);

    std::string name_;
    std::vector<BindingInfo> bindings_;
    std::uint32_t pushBytes_ = 0;
    std::shared_ptr<Pipeline> pipeline_;
};

/// A compute program with push constants of type Push (scalar layout, the same struct as in the shader).
/// Throws std::logic_error where sizeof(Push) differs from the shader's block, or a constant's id is not the shader's.
template <class Push>
class Program : public ProgramBase {
    static_assert(std::is_trivially_copyable_v<Push>);

  public:
    Program(Context& context, std::string name, std::span<const std::uint32_t> spirv,
            const std::vector<SpecConstant>& constants = {})
        : ProgramBase(context, std::move(name), spirv, constants, std::is_empty_v<Push> ? 0 : sizeof(Push),
                      alignof(Push)) {}
};

}  // namespace lumulus::gpu
