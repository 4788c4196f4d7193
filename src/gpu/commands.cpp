#include "gpu/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

[[noreturn]] void fail(const ProgramBase& program, std::string_view binding, std::string_view what) {
    throw std::logic_error(fmt::format("{}: binding {} {}", program.name(), binding, what));
}

/// Names that the shader does not have, or that come twice.
void rejectOthers(const ProgramBase& program, const std::vector<Binding>& bindings) {
    for (const Binding& binding : bindings) {
        const auto same = [&](const auto& other) { return other.name == binding.name; };
        if (std::ranges::none_of(program.bindings(), same)) fail(program, binding.name, "is not in the shader");
        if (std::ranges::count_if(bindings, same) > 1) fail(program, binding.name, "is given twice");
    }
}

/// The one that fits what the shader declares.
const Binding& findBinding(const ProgramBase& program, const std::vector<Binding>& bindings, const BindingInfo& info) {
    const auto found = std::ranges::find(bindings, info.name, &Binding::name);
    if (found == bindings.end()) fail(program, info.name, "is missing");
    const bool isBuffer = found->buffer != nullptr;
    if (isBuffer != info.isBuffer())
        fail(program, info.name, isBuffer ? "is an image in the shader" : "is a buffer in the shader");
    if (isBuffer && info.kind == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER && found->buffer->texels() == VK_NULL_HANDLE)
        fail(program, info.name, "needs a buffer of texels");
    if (isBuffer) return *found;
    const Image& image = *found->image;
    const bool sampled = info.kind == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    if (image.dimensions() != info.dimensions || image.isArray() != info.isArray ||
        sampled != (found->sampler != Sampler::none))
        fail(program, info.name,
             fmt::format("needs a {}D image {}{} sampler", info.dimensions, info.isArray ? "array " : "",
                         sampled ? "with a" : "without a"));
    if (!sampled && image.levels() > 1 && !found->part) fail(program, info.name, "needs one level of the image");
    if (found->part && found->part->layer) fail(program, info.name, "cannot be one layer of the image");
    return *found;
}

/// Adds what the program does to the resource of a binding: to each of its levels.
void addAccesses(std::vector<Access>& accesses, const Binding& binding, const BindingInfo& info) {
    const bool isBuffer = binding.buffer != nullptr;
    const Resource& resource = isBuffer ? static_cast<const Resource&>(*binding.buffer) : *binding.image;
    const int levels = isBuffer ? 1 : binding.image->levels();
    for (int level = 0; level < levels; ++level) {
        if (binding.part && binding.part->level != level) continue;
        const std::string name = levels > 1 ? fmt::format("{} level {}", resource.name(), level) : resource.name();
        accesses.push_back({resource.id(), name, info.reads, info.writes, static_cast<std::uint32_t>(level)});
    }
}

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
    std::vector<VkDescriptorBufferInfo> buffers(program.bindings().size());
    std::vector<VkDescriptorImageInfo> images(program.bindings().size());
    std::vector<VkBufferView> texels(program.bindings().size());
    std::vector<VkWriteDescriptorSet> writes;
    std::vector<Access> accesses;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const BindingInfo& info = program.bindings()[i];
        const Binding& binding = findBinding(program, bindings, info);
        if (binding.buffer != nullptr) {
            buffers[i] = {binding.buffer->handle(), 0, VK_WHOLE_SIZE};
            texels[i] = binding.buffer->texels();
        } else {
            const VkImageView view = binding.part ? binding.image->view(binding.part->level) : binding.image->view();
            images[i] = {context_->sampler(binding.sampler), view, VK_IMAGE_LAYOUT_GENERAL};
        }
        addAccesses(accesses, binding, info);
        writes.push_back({VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, VK_NULL_HANDLE, info.binding, 0, 1,
                          info.kind, &images[i], &buffers[i], &texels[i]});
    }
    if (arguments != nullptr) accesses.push_back({arguments->id(), arguments->name(), true, false});
    add(arguments != nullptr ? StepKind::indirect : StepKind::dispatch, program.name(), accesses);

    const VolkDeviceTable& api = context_->api();
    VkCommandBuffer commands = commands_.handle;
    api.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline());
    if (!writes.empty())
        api.vkCmdPushDescriptorSetKHR(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout(), 0,
                                      static_cast<std::uint32_t>(writes.size()), writes.data());
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
