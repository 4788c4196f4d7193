#pragma once

#include <volk.h>

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu/owned.h"

namespace lumulus::gpu {

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

/// Timestamps around named spans of one command buffer. Query pools are added as spans need them and kept.
class Timer {
  public:
    explicit Timer(Context& context) : context_(&context) {}

    /// Forgets the spans: the next command buffer begins.
    void reset();
    /// Begins a span; ends the open one.
    void start(VkCommandBuffer commands, const std::string& name);
    void stop(VkCommandBuffer commands);
    /// The spans in order, once the command buffer has run.
    std::vector<PassTime> read() const;

  private:
    void stamp(VkCommandBuffer commands);

    Context* context_;
    std::vector<Owned<VkQueryPool>> pools_;
    std::vector<std::string> names_;
    std::uint32_t stamps_ = 0;  ///< written so far: two for each span, the open one has one
};

}  // namespace lumulus::gpu
