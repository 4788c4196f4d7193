#include "gpu/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

[[noreturn]] void fail(const ProgramBase& program, std::string_view binding, std::string_view what) {
    throw std::logic_error(fmt::format("{}: binding {} {}", program.name(), binding, what));
}

/// Names that the shader does not have, or that come more often than it declares.
void rejectOthers(const ProgramBase& program, const std::vector<Binding>& bindings) {
    for (const Binding& binding : bindings) {
        const auto same = [&](const auto& other) { return other.name == binding.name; };
        const auto info = std::ranges::find_if(program.bindings(), same);
        if (info == program.bindings().end()) fail(program, binding.name, "is not in the shader");
        if (std::ranges::count_if(bindings, same) > std::ptrdiff_t{info->count})
            fail(program, binding.name, info->count == 1 ? "is given twice" : "is given too often");
    }
}

/// Whether a resource is what the shader declares.
void requireFit(const ProgramBase& program, const Binding& given, const BindingInfo& info) {
    const bool isBuffer = given.buffer != nullptr;
    if (isBuffer != info.isBuffer())
        fail(program, info.name, isBuffer ? "is an image in the shader" : "is a buffer in the shader");
    if (isBuffer && info.kind == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER && given.buffer->texels() == VK_NULL_HANDLE)
        fail(program, info.name, "needs a buffer of texels");
    if (isBuffer) return;
    const bool sampled = info.kind == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    if (given.image->dimensions() != info.dimensions || sampled != (given.sampler != Sampler::none))
        fail(program, info.name,
             fmt::format("needs a {}D image {} sampler", info.dimensions, sampled ? "with a" : "without a"));
}

/// The ones that the shader declares under one name, in order: an array needs all its resources.
std::vector<const Binding*> findBindings(const ProgramBase& program, const std::vector<Binding>& bindings,
                                         const BindingInfo& info) {
    std::vector<const Binding*> found;
    for (const Binding& binding : bindings) {
        if (binding.name != info.name) continue;
        requireFit(program, binding, info);
        found.push_back(&binding);
    }
    if (found.size() != info.count)
        fail(program, info.name, found.empty() ? "is missing" : "has fewer resources than the shader's array");
    return found;
}

/// What a dispatch binds, as Vulkan takes it. The vectors never grow after construction: `writes` points into them.
struct Descriptors {
    explicit Descriptors(const ProgramBase& program) {
        std::size_t count = 0;
        for (const BindingInfo& info : program.bindings()) count += info.count;
        buffers.reserve(count);
        images.reserve(count);
        texels.reserve(count);
    }

    void add(Context& context, const BindingInfo& info, const std::vector<const Binding*>& resources) {
        const std::size_t first = buffers.size();
        for (const Binding* given : resources) {
            const auto& [name, buffer, image, sampler] = *given;
            buffers.push_back(buffer != nullptr ? VkDescriptorBufferInfo{buffer->handle(), 0, VK_WHOLE_SIZE}
                                                : VkDescriptorBufferInfo{});
            texels.push_back(buffer != nullptr ? buffer->texels() : VK_NULL_HANDLE);
            images.push_back(image != nullptr ? VkDescriptorImageInfo{context.sampler(sampler), image->view(),
                                                                      VK_IMAGE_LAYOUT_GENERAL}
                                              : VkDescriptorImageInfo{});
            const Resource& resource = buffer != nullptr ? static_cast<const Resource&>(*buffer) : *image;
            accesses.push_back({resource.id(), resource.name(), info.reads, info.writes});
        }
        writes.push_back({VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, VK_NULL_HANDLE, info.binding, 0, info.count,
                          info.kind, &images[first], &buffers[first], &texels[first]});
    }

    std::vector<VkDescriptorBufferInfo> buffers;
    std::vector<VkDescriptorImageInfo> images;
    std::vector<VkBufferView> texels;
    std::vector<VkWriteDescriptorSet> writes;
    std::vector<Access> accesses;
};

}  // namespace

Commands::Commands(Context& context) : context_(&context), commands_(context.makeCommandBuffer("commands")) {
    const VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, nullptr, 0, VK_QUERY_TYPE_TIMESTAMP,
                                     2 * maxPasses};
    stamps_ = context.create(context.api().vkCreateQueryPool, context.api().vkDestroyQueryPool, info,
                             VK_OBJECT_TYPE_QUERY_POOL, "timestamps");
}

Commands::~Commands() {
    // no check: the work of a lost device is over as well
    if (state_ == State::submitted) context_->api().vkDeviceWaitIdle(context_->handle());
}

void Commands::require(State state, const std::string& call) const {
    if (state_ == state) return;
    const char* names[] = {"idle", "recording", "submitted"};
    throw std::logic_error(fmt::format("Commands: {} while {}", call, names[static_cast<int>(state_)]));
}

void Commands::add(StepKind kind, const std::string& name, std::span<const Access> accesses) {
    require(State::recording, name);
    hazards_.use(name, accesses);
    steps_.push_back({kind, name});
}

void Commands::begin() {
    if (state_ == State::submitted) require(State::idle, "begin");
    context_->begin(commands_);
    context_->api().vkCmdResetQueryPool(commands_.handle, stamps_.get(), 0, 2 * maxPasses);
    stampCount_ = 0;
    hazards_.barrier();
    steps_.clear();
    times_.clear();
    state_ = State::recording;
}

void Commands::stamp() {
    // ALL_COMMANDS at both ends: a pass begins when the work before it is done
    context_->api().vkCmdWriteTimestamp(commands_.handle, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, stamps_.get(),
                                        stampCount_++);
}

void Commands::endPass() {
    if (times_.empty()) return;
    stamp();
    vkCmdEndDebugUtilsLabelEXT(commands_.handle);
}

void Commands::pass(const std::string& name) {
    if (times_.size() == maxPasses) throw std::logic_error("Commands: too many passes");
    add(StepKind::pass, name, {});
    endPass();
    times_.push_back({name});
    stamp();
    const VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name.c_str()};
    vkCmdBeginDebugUtilsLabelEXT(commands_.handle, &label);
}

void Commands::record(const ProgramBase& program, const std::vector<Binding>& bindings, const void* push,
                      glm::uvec3 groups, const Buffer* arguments, std::uint64_t offset) {
    rejectOthers(program, bindings);
    const auto& limit = context_->limits().maxComputeWorkGroupCount;
    if (groups.x > limit[0] || groups.y > limit[1] || groups.z > limit[2])
        throw std::logic_error(fmt::format("{}: {}x{}x{} groups are above the device's limit of {}x{}x{}",
                                           program.name(), groups.x, groups.y, groups.z, limit[0], limit[1], limit[2]));
    if (arguments != nullptr && arguments->bytes() < offset + sizeof(VkDispatchIndirectCommand))
        throw std::logic_error(fmt::format("{}: the arguments at {} do not lie in {} of {} bytes", program.name(),
                                           offset, arguments->name(), arguments->bytes()));
    Descriptors descriptors(program);
    for (const BindingInfo& info : program.bindings())
        descriptors.add(*context_, info, findBindings(program, bindings, info));
    if (arguments != nullptr) descriptors.accesses.push_back({arguments->id(), arguments->name(), true, false});
    add(arguments != nullptr ? StepKind::indirect : StepKind::dispatch, program.name(), descriptors.accesses);

    const VolkDeviceTable& api = context_->api();
    VkCommandBuffer commands = commands_.handle;
    api.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline());
    if (!descriptors.writes.empty())
        api.vkCmdPushDescriptorSetKHR(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout(), 0,
                                      static_cast<std::uint32_t>(descriptors.writes.size()), descriptors.writes.data());
    if (program.pushBytes() > 0)
        api.vkCmdPushConstants(commands, program.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, program.pushBytes(), push);
    if (arguments != nullptr)
        api.vkCmdDispatchIndirect(commands, arguments->handle(), offset);
    else
        api.vkCmdDispatch(commands, groups.x, groups.y, groups.z);
}

void Commands::fill(Buffer& buffer, std::uint32_t value) {
    const Access access{buffer.id(), buffer.name(), false, true};
    add(StepKind::fill, "fill " + buffer.name(), {&access, 1});
    context_->api().vkCmdFillBuffer(commands_.handle, buffer.handle(), 0, VK_WHOLE_SIZE, value);
}

void Commands::barrier(const std::string& name) {
    add(StepKind::barrier, name, {});
    hazards_.barrier();
    context_->recordFullBarrier(commands_.handle);
}

void Commands::submit() {
    require(State::recording, "submit");
    endPass();
    context_->submit(commands_);
    state_ = State::submitted;
}

void Commands::wait() {
    require(State::submitted, "wait");
    context_->wait(commands_);
    state_ = State::idle;
    if (times_.empty()) return;
    std::vector<std::uint64_t> ticks(stampCount_);
    check(context_->api().vkGetQueryPoolResults(context_->handle(), stamps_.get(), 0, stampCount_, stampCount_ * 8,
                                                ticks.data(), 8, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    const std::uint64_t mask = ~0ULL >> (64 - context_->timestampBits());
    const double period = static_cast<double>(context_->limits().timestampPeriod);  // ns
    for (std::size_t i = 0; i < times_.size(); ++i) {
        const std::uint64_t elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
        times_[i].milliseconds = static_cast<double>(elapsed) * period * 1e-6;
    }
}

}  // namespace lumulus::gpu
