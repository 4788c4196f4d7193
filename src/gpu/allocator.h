#pragma once

#include <map>
#include <mutex>
#include <utility>

#include "base/free_list.h"
#include "gpu/device.h"

namespace lumulus::gpu {

enum class Memory {
    device,  ///< fast for the GPU; filled and read by transfer.h
    host     ///< mapped for as long as the buffer lives, coherent; cached where the device has it
};

/// Buffers are linear, images optimal. They share no block, so that bufferImageGranularity never matters.
enum class Tiling { linear, optimal };

/// Bytes of GPU memory.
struct MemoryStatistics {
    std::uint64_t used = 0;         ///< taken by buffers and images, as Vulkan sizes them
    std::uint64_t held = 0;         ///< allocated from the driver; what is not used waits for the next resource
    std::uint64_t peakUsed = 0;     ///< the most that was used at one time
    std::uint32_t allocations = 0;  ///< living VkDeviceMemory objects; many devices allow 4096
};

struct MemoryPool;

/// One VkDeviceMemory.
struct MemoryBlock {
    MemoryPool* pool;
    Owned<VkDeviceMemory> memory;
    bool shared;        ///< among resources; otherwise of a single one
    std::byte* mapped;  ///< for the whole life of the block; null where the host cannot see the memory
    std::uint64_t bytes;
    FreeList free{bytes};
};

/// The blocks of one memory type and tiling.
struct MemoryPool {
    std::uint32_t type = 0;  ///< of memory
    std::uint64_t used = 0;  ///< bytes
    std::vector<std::unique_ptr<MemoryBlock>> blocks;
};

/// Where the memory of one resource lies.
struct Placement {
    MemoryBlock* block = nullptr;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    std::uint64_t id = 0;  ///< counts from 1; no other placement of the allocator ever has the same

    VkDeviceMemory memory() const { return block->memory.get(); }
    /// Null where the host cannot see the memory; it always sees Memory::host.
    std::byte* mapped() const { return block->mapped == nullptr ? nullptr : block->mapped + offset; }
};

struct ReturnMemory {
    class Allocator* allocator = nullptr;

    void operator()(Placement* placement) const;
};

/// Device memory of one resource, given back with its owner, in any order.
using Allocation = std::unique_ptr<Placement, ReturnMemory>;

/// Divides blocks of device memory among buffers and images. A new block is a quarter of what its pool uses, from 4 to
/// 64 MiB, so a small program holds little and a large one makes few allocations. A resource above half of that size
/// gets an allocation of its own. An empty block goes back to the driver, but a pool with resources keeps one, so that
/// a resource that comes and goes costs nothing. May be used from several threads.
class Allocator {
  public:
    static constexpr std::uint64_t leastBlockBytes = 4ULL << 20U;
    static constexpr std::uint64_t mostBlockBytes = 64ULL << 20U;

    /// `api` must outlive the allocator; `maxAllocationBytes` is the device's limit for one allocation.
    Allocator(VkPhysicalDevice physical, VkDevice device, const VolkDeviceTable& api, std::uint64_t maxAllocationBytes);
    Allocator(const Allocator&) = delete;

    /// Errors: Error naming the resource and the bytes where memory runs out.
    Allocation allocate(const std::string& resource, const VkMemoryRequirements& needs, Memory where, Tiling tiling);
    MemoryStatistics statistics() const;

  private:
    friend ReturnMemory;

    std::uint32_t findMemoryType(std::uint32_t allowed, Memory where) const;
    Placement place(MemoryPool& pool, const std::string& resource, const VkMemoryRequirements& needs);
    VkResult addBlock(MemoryPool& pool, const std::string& name, std::uint64_t bytes, bool shared);
    void removeUnusedBlocks(MemoryPool& pool, std::size_t spares);

    VkDevice device_;
    const VolkDeviceTable* api_;
    std::uint64_t maxAllocationBytes_;
    VkPhysicalDeviceMemoryProperties memory_{};
    mutable std::mutex mutex_;
    MemoryStatistics statistics_;
    std::uint64_t lastId_ = 0;
    std::map<std::pair<std::uint32_t, Tiling>, MemoryPool> pools_;  ///< by memory type and tiling
};

}  // namespace lumulus::gpu
