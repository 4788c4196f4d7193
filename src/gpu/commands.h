#pragma once

#include <glm/glm.hpp>

#include "base/hazards.h"
#include "gpu/memory.h"
#include "gpu/program.h"

namespace lumulus::gpu {

/// A resource under the name that the shader gives it (see BindingInfo::name). Lives for one call.
struct Binding {
    Binding(std::string_view bindingName, const Buffer& resource) : name(bindingName), buffer(&resource) {}
    Binding(std::string_view bindingName, const Image& resource, Sampler how = Sampler::none)
        : name(bindingName), image(&resource), sampler(how) {}
    /// One mip level of an image with all layers: needed to store to an image of several levels.
    Binding(std::string_view bindingName, const ImageLevel& resource, Sampler how = Sampler::none)
        : name(bindingName), image(resource.image), sampler(how), part(resource) {}

    std::string_view name;
    const Buffer* buffer = nullptr;
    const Image* image = nullptr;
    Sampler sampler = Sampler::none;
    std::optional<ImageLevel> part;  ///< none: the whole image
};

enum class StepKind { pass, dispatch, indirect, fill, barrier };

/// One recorded command, as a value that tests can look at.
struct Step {
    StepKind kind;
    std::string name;

    bool operator==(const Step&) const = default;
};

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

/// A command buffer: begin(), commands, submit(), wait(); then again. Resources and programs must live until wait().
/// Every command is checked against the ones since the last barrier (HazardTracker), always.
/// Errors: std::logic_error for a missing barrier, bindings that are not the shader's, sizes that do not fit, more
/// than `maxPasses`, or calls out of order; Error where Vulkan fails.
class Commands {
  public:
    static constexpr std::uint32_t maxPasses = 1024;

    explicit Commands(Context& context);
    Commands(const Commands&) = delete;
    ~Commands();

    /// Starts to record, after everything submitted before. What was recorded and not submitted is dropped.
    void begin();
    /// Starts a named pass: a label for debuggers and two timestamps. Ends the one before.
    void pass(const std::string& name);
    /// Runs `groups` workgroups. `bindings` must name all that the shader declares and nothing else.
    template <class Push>
    void dispatch(const Program<Push>& program, const std::vector<Binding>& bindings,
                  const std::type_identity_t<Push>& push, glm::uvec3 groups) {
        record(program, bindings, &push, groups, nullptr, 0);
    }
    /// As dispatch; the count of groups is read from `arguments` at `offset` (three uint32, offset a multiple of 4).
    template <class Push>
    void dispatchIndirect(const Program<Push>& program, const std::vector<Binding>& bindings,
                          const std::type_identity_t<Push>& push, const Buffer& arguments, std::uint64_t offset = 0) {
        record(program, bindings, &push, {}, &arguments, offset);
    }
    /// Sets every 32-bit word of the buffer.
    void fill(Buffer& buffer, std::uint32_t value);
    /// All writes before (shader, transfer) are visible to all reads and writes after (also indirect and host).
    void barrier(const std::string& name);
    /// Ends the recording and hands it to the queue.
    void submit();
    /// Waits for the submitted work; afterwards host memory shows all that it wrote.
    void wait();

    /// The passes of the last submission in order, after wait().
    const std::vector<PassTime>& times() const { return times_; }
    /// What was recorded since begin().
    const std::vector<Step>& steps() const { return steps_; }

  private:
    enum class State { idle, recording, submitted };

    void record(const ProgramBase& program, const std::vector<Binding>& bindings, const void* push, glm::uvec3 groups,
                const Buffer* arguments, std::uint64_t offset);
    void add(StepKind kind, const std::string& name, std::span<const Access> accesses);
    void require(State state, const std::string& call) const;
    void endPass();
    void stamp();

    Context* context_;
    CommandBuffer commands_;
    Owned<VkQueryPool> stamps_;  ///< two for each pass
    std::uint32_t stampCount_ = 0;
    State state_ = State::idle;
    HazardTracker hazards_;
    std::vector<Step> steps_;
    std::vector<PassTime> times_;
};

}  // namespace lumulus::gpu
