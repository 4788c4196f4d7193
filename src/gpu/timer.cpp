#include "gpu/timer.h"

#include <algorithm>

#include "gpu/result.h"

namespace lumulus::gpu {
namespace {
constexpr std::uint32_t poolStamps = 128;
}

void Timer::reset() {
    names_.clear();
    stamps_ = 0;
}

void Timer::start(VkCommandBuffer commands, const std::string& name) {
    stop(commands);
    names_.push_back(name);
    stamp(commands);
}

void Timer::stop(VkCommandBuffer commands) {
    if (stamps_ < 2 * names_.size()) {
        stamp(commands);
    }
}

void Timer::stamp(VkCommandBuffer commands) {
    const VolkDeviceTable& api = context_->api();
    const std::uint32_t pool = stamps_ / poolStamps;
    if (pool == pools_.size()) {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = poolStamps;
        pools_.push_back(context_->create(api.vkCreateQueryPool, api.vkDestroyQueryPool, info,
                                          VK_OBJECT_TYPE_QUERY_POOL, "timestamps"));
    }
    if (stamps_ % poolStamps == 0) {
        api.vkCmdResetQueryPool(commands, pools_[pool].get(), 0, poolStamps);
    }
    // ALL_COMMANDS at both ends: a span begins when the work before it is done
    api.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pools_[pool].get(), stamps_ % poolStamps);
    ++stamps_;
}

std::vector<PassTime> Timer::read() const {
    std::vector<std::uint64_t> ticks(stamps_);
    for (std::uint32_t first = 0; first < stamps_; first += poolStamps) {
        const std::uint32_t count = std::min(poolStamps, stamps_ - first);
        check(context_->api().vkGetQueryPoolResults(context_->handle(), pools_[first / poolStamps].get(), 0, count,
                                                    count * sizeof(std::uint64_t), &ticks[first], sizeof(std::uint64_t),
                                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "vkGetQueryPoolResults");
    }
    const std::uint32_t bits = context_->timestampBits();
    const std::uint64_t mask = bits >= 64 ? ~0ULL : (1ULL << bits) - 1;
    const double period = static_cast<double>(context_->limits().timestampPeriod);  // ns
    std::vector<PassTime> times;
    for (std::size_t i = 0; i < names_.size(); ++i) {
        const std::uint64_t elapsed = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
        times.push_back({names_[i], static_cast<double>(elapsed) * period * 1e-6});
    }
    return times;
}

}  // namespace lumulus::gpu
