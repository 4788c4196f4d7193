#include "gpu/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "gpu/result.h"

namespace lumulus::gpu {
namespace {

[[noreturn]] void fail(const ProgramBase& program, std::string_view binding, std::string_view what) {
    throw std::logic_error(fmt::format("{}: binding {} {}", program.name(), binding, what));
}

const Binding& findBinding(const ProgramBase& program, std::span<const Binding> bindings, const BindingInfo& info) {
    const auto found = std::find_if(bindings.begin(), bindings.end(),
                                    [&](const Binding& binding) { return binding.name == info.name; });
    if (found == bindings.end()) {
        fail(program, info.name, "is missing");
    }
    return *found;
}

/// Names that the shader does not have, or that come twice.
void rejectOthers(const ProgramBase& program, std::span<const Binding> bindings) {
    for (const Binding& binding : bindings) {
        const auto same = [&](const auto& other) { return other.name == binding.name; };
        if (std::none_of(program.bindings().begin(), program.bindings().end(), same)) {
            fail(program, binding.name, "is not in the shader");
        }
        if (std::count_if(bindings.begin(), bindings.end(), same) > 1) {
            fail(program, binding.name, "is given twice");
        }
    }
}

void checkKind(const ProgramBase& program, const BindingInfo& info, const Binding& binding) {
    if ((info.kind == BindingKind::storageBuffer) != (binding.buffer != nullptr)) {
        fail(program, info.name, binding.buffer != nullptr ? "is an image in the shader" : "is a buffer in the shader");
    }
    if (binding.buffer != nullptr) {
        return;
    }
    const Image& image = *binding.image;
    if (image.dimensions() != info.dimensions) {
        fail(program, info.name, info.dimensions == 3 ? "needs a 3D image" : "needs a 2D image");
    }
    const bool sampled = info.kind == BindingKind::sampledImage;
    if (sampled != (binding.sampler != Sampler::none)) {
        fail(program, info.name, sampled ? "needs a sampler" : "is a storage image, without a sampler");
    }
    if (!sampled && !image.canStore()) {
        fail(program, info.name, "has a format that shaders cannot store to");
    }
    if (sampled && binding.sampler != Sampler::nearest && !image.canFilter()) {
        fail(program, info.name, "has a format that cannot be filtered");
    }
}

/// Descriptor writes and the infos that they point at.
struct DescriptorWrites {
    std::vector<VkDescriptorBufferInfo> buffers;
    std::vector<VkDescriptorImageInfo> images;
    std::vector<VkWriteDescriptorSet> writes;

    explicit DescriptorWrites(std::size_t count) {
        buffers.reserve(count);  // no address may change
        images.reserve(count);
    }

    void add(const Context& context, const BindingInfo& info, const Binding& binding) {
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstBinding = info.binding;
        write.descriptorCount = 1;
        if (binding.buffer != nullptr) {
            write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            write.pBufferInfo =
                &buffers.emplace_back(VkDescriptorBufferInfo{binding.buffer->handle(), 0, VK_WHOLE_SIZE});
        } else {
            const bool sampled = binding.sampler != Sampler::none;
            write.descriptorType =
                sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
            VkSampler sampler = sampled ? context.sampler(binding.sampler, binding.image->isInteger()) : VK_NULL_HANDLE;
            write.pImageInfo =
                &images.emplace_back(VkDescriptorImageInfo{sampler, binding.image->view(), VK_IMAGE_LAYOUT_GENERAL});
        }
        writes.push_back(write);
    }
};

void requireRange(const Buffer& buffer, std::uint64_t offset, std::uint64_t bytes, const char* what) {
    if (offset > buffer.bytes() || bytes > buffer.bytes() - offset) {
        throw std::logic_error(fmt::format("{}: {} bytes at {} do not lie in {} of {} bytes", what, bytes, offset,
                                           buffer.name(), buffer.bytes()));
    }
}

VkBufferImageCopy wholeImage(const Image& image) {
    const glm::uvec3 extent(image.extent());
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {extent.x, extent.y, extent.z};
    return region;
}

template <class Resource>
Access reading(const Resource& resource) {
    return {resource.id(), resource.name(), true, false};
}

template <class Resource>
Access writing(const Resource& resource) {
    return {resource.id(), resource.name(), false, true};
}

}  // namespace

Commands::Commands(Context& context) : context_(&context), timer_(context) {
    const VolkDeviceTable& api = context.api();
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = context.queueFamily();
    pool_ = context.create(api.vkCreateCommandPool, api.vkDestroyCommandPool, pool, VK_OBJECT_TYPE_COMMAND_POOL,
                           "commands");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    fence_ = context.create(api.vkCreateFence, api.vkDestroyFence, fence, VK_OBJECT_TYPE_FENCE, "commands");
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = pool_.get();
    info.commandBufferCount = 1;
    check(api.vkAllocateCommandBuffers(context.handle(), &info, &commands_), "vkAllocateCommandBuffers");
}

Commands::~Commands() {
    if (state_ == State::submitted) {
        VkFence fence = fence_.get();  // no check: the work of a lost device is over as well
        context_->api().vkWaitForFences(context_->handle(), 1, &fence, VK_TRUE, ~0ULL);
    }
}

void Commands::require(State state, const char* call) const {
    if (state_ != state) {
        const char* names[] = {"idle", "recording", "submitted"};
        throw std::logic_error(fmt::format("Commands::{} while {}", call, names[static_cast<int>(state_)]));
    }
}

void Commands::add(StepKind kind, const std::string& name, std::span<const Access> accesses) {
    require(State::recording, name.c_str());
    hazards_.use(name, accesses);
    steps_.push_back({kind, name});
}

void Commands::begin() {
    if (state_ == State::submitted) {
        require(State::idle, "begin");
    }
    const VolkDeviceTable& api = context_->api();
    check(api.vkResetCommandPool(context_->handle(), pool_.get(), 0), "vkResetCommandPool");
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(api.vkBeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
    context_->recordFullBarrier(commands_);
    hazards_.barrier();
    steps_.clear();
    times_.clear();
    timer_.reset();
    labelled_ = false;
    state_ = State::recording;
}

void Commands::endLabel() {
    if (labelled_) {
        vkCmdEndDebugUtilsLabelEXT(commands_);
    }
    labelled_ = false;
}

void Commands::pass(const std::string& name) {
    add(StepKind::pass, name, {});
    endLabel();
    timer_.start(commands_, name);
    if (context_->hasDebugUtils()) {
        VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = name.c_str();
        vkCmdBeginDebugUtilsLabelEXT(commands_, &label);
        labelled_ = true;
    }
}

void Commands::record(const ProgramBase& program, std::span<const Binding> bindings, const void* push,
                      glm::uvec3 groups, const Buffer* arguments, std::uint64_t offset) {
    rejectOthers(program, bindings);
    DescriptorWrites writes(bindings.size());
    std::vector<Access> accesses;
    for (const BindingInfo& info : program.bindings()) {
        const Binding& binding = findBinding(program, bindings, info);
        checkKind(program, info, binding);
        writes.add(*context_, info, binding);
        Access access = binding.buffer != nullptr ? reading(*binding.buffer) : reading(*binding.image);
        access.reads = info.reads;
        access.writes = info.writes;
        accesses.push_back(access);
    }
    if (arguments != nullptr) {
        requireRange(*arguments, offset, sizeof(VkDispatchIndirectCommand), program.name().c_str());
        accesses.push_back(reading(*arguments));
    }
    checkGroups(program, groups);
    add(arguments != nullptr ? StepKind::indirect : StepKind::dispatch, program.name(), accesses);

    const VolkDeviceTable& api = context_->api();
    api.vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline());
    if (!writes.writes.empty()) {
        api.vkCmdPushDescriptorSetKHR(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout(), 0,
                                      static_cast<std::uint32_t>(writes.writes.size()), writes.writes.data());
    }
    if (program.pushBytes() > 0) {
        api.vkCmdPushConstants(commands_, program.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, program.pushBytes(), push);
    }
    if (arguments != nullptr) {
        api.vkCmdDispatchIndirect(commands_, arguments->handle(), offset);
    } else {
        api.vkCmdDispatch(commands_, groups.x, groups.y, groups.z);
    }
}

void Commands::checkGroups(const ProgramBase& program, glm::uvec3 groups) const {
    const auto& limit = context_->limits().maxComputeWorkGroupCount;
    if (groups.x > limit[0] || groups.y > limit[1] || groups.z > limit[2]) {
        throw std::logic_error(fmt::format("{}: {}x{}x{} groups are above the device's limit of {}x{}x{}",
                                           program.name(), groups.x, groups.y, groups.z, limit[0], limit[1], limit[2]));
    }
}

void Commands::fill(Buffer& buffer, std::uint32_t value) {
    const Access access = writing(buffer);
    add(StepKind::fill, "fill " + buffer.name(), {&access, 1});
    context_->api().vkCmdFillBuffer(commands_, buffer.handle(), 0, VK_WHOLE_SIZE, value);
}

template <class From, class To>
void Commands::addCopy(const From& from, const To& to) {
    const Access accesses[] = {reading(from), writing(to)};
    add(StepKind::copy, fmt::format("copy {} to {}", from.name(), to.name()), accesses);
}

void Commands::copy(const Buffer& from, Buffer& to, std::uint64_t bytes, std::uint64_t fromOffset,
                    std::uint64_t toOffset) {
    requireRange(from, fromOffset, bytes, "copy");
    requireRange(to, toOffset, bytes, "copy");
    addCopy(from, to);
    const VkBufferCopy region{fromOffset, toOffset, bytes};
    context_->api().vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
}

void Commands::copy(const Buffer& from, Image& to) {
    requireRange(from, 0, to.bytes(), "copy");
    addCopy(from, to);
    const VkBufferImageCopy region = wholeImage(to);
    context_->api().vkCmdCopyBufferToImage(commands_, from.handle(), to.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &region);
}

void Commands::copy(const Image& from, Buffer& to) {
    requireRange(to, 0, from.bytes(), "copy");
    addCopy(from, to);
    const VkBufferImageCopy region = wholeImage(from);
    context_->api().vkCmdCopyImageToBuffer(commands_, from.handle(), VK_IMAGE_LAYOUT_GENERAL, to.handle(), 1, &region);
}

void Commands::barrier(const std::string& name) {
    add(StepKind::barrier, name, {});
    hazards_.barrier();
    context_->recordFullBarrier(commands_);
}

void Commands::submit() {
    require(State::recording, "submit");
    timer_.stop(commands_);
    endLabel();
    context_->recordFullBarrier(commands_);
    check(context_->api().vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
    context_->submit(commands_, fence_.get());
    state_ = State::submitted;
}

void Commands::wait() {
    require(State::submitted, "wait");
    context_->waitFor(fence_.get());
    state_ = State::idle;
    times_ = timer_.read();
}

}  // namespace lumulus::gpu
