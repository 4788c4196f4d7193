#include "gpu/allocator.h"

#include <sanitizer/asan_interface.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace lumulus::gpu {

Allocator::Allocator(VkPhysicalDevice physical, VkDevice device, const VolkDeviceTable& api,
                     std::uint64_t maxAllocationBytes)
    : device_(device), api_(&api), maxAllocationBytes_(maxAllocationBytes) {
    vkGetPhysicalDeviceMemoryProperties(physical, &memory_);
}

/// The first memory type that fits, with as many of the wanted properties as one has, best wish first.
std::uint32_t Allocator::findMemoryType(std::uint32_t allowed, Memory where) const {
    constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags hostWishes[] = {host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, host};
    const VkMemoryPropertyFlags deviceWishes[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    for (const VkMemoryPropertyFlags wish : where == Memory::host ? hostWishes : deviceWishes)
        for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
            if ((allowed & (1U << i)) != 0 && (memory_.memoryTypes[i].propertyFlags & wish) == wish) return i;
    throw std::logic_error("Vulkan promises a memory type for every buffer and image");
}

Allocation Allocator::allocate(const std::string& resource, const VkMemoryRequirements& needs, Memory where,
                               Tiling tiling) {
    const std::lock_guard lock(mutex_);
    const std::uint32_t type = findMemoryType(needs.memoryTypeBits, where);
    auto placement = std::make_unique<Placement>(
        place(pools_.try_emplace({type, tiling}, MemoryPool{type}).first->second, resource, needs));
    placement->id = ++lastId_;
    placement->block->pool->used += needs.size;
    statistics_.used += needs.size;
    statistics_.peakUsed = std::max(statistics_.peakUsed, statistics_.used);
    if (placement->mapped() != nullptr) ASAN_UNPOISON_MEMORY_REGION(placement->mapped(), needs.size);
    return {placement.release(), {this}};
}

Placement Allocator::place(MemoryPool& pool, const std::string& resource, const VkMemoryRequirements& needs) {
    for (const auto& block : pool.blocks)
        if (const auto offset = block->free.take(needs.size, needs.alignment))
            return {block.get(), *offset, needs.size};
    const std::uint64_t quarter = std::clamp(std::bit_floor(pool.used / 4), leastBlockBytes, mostBlockBytes);
    const std::uint64_t blockBytes = std::min(quarter, maxAllocationBytes_);
    const bool shared = needs.size <= blockBytes / 2 && addBlock(pool, "block", blockBytes, true) == VK_SUCCESS;
    if (!shared && addBlock(pool, resource, needs.size, false) != VK_SUCCESS) {
        for (auto& [key, other] : pools_) removeUnusedBlocks(other, 0);
        checkMemory(addBlock(pool, resource, needs.size, false), "vkAllocateMemory", resource, needs.size);
    }
    MemoryBlock& added = *pool.blocks.back();
    return {&added, added.free.take(needs.size, needs.alignment).value(), needs.size};
}

VkResult Allocator::addBlock(MemoryPool& pool, const std::string& name, std::uint64_t bytes, bool shared) {
    if (bytes > maxAllocationBytes_) return VK_ERROR_OUT_OF_DEVICE_MEMORY;  // some drivers take it, and fail in use
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, bytes, pool.type};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkResult result = api_->vkAllocateMemory(device_, &info, nullptr, &memory);
    if (result != VK_SUCCESS) return result;
    Owned<VkDeviceMemory> owned(memory, {device_, api_->vkFreeMemory});
    setObjectName(device_, VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<std::uint64_t>(memory), name);
    void* mapped = nullptr;
    if ((memory_.memoryTypes[pool.type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
        result = api_->vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS) return result;
        // a build with AddressSanitizer reports who touches memory that no resource has
        ASAN_POISON_MEMORY_REGION(mapped, bytes);
    }
    pool.blocks.emplace_back(
        new MemoryBlock{&pool, std::move(owned), shared, static_cast<std::byte*>(mapped), bytes, FreeList(bytes)});
    statistics_.held += bytes;
    ++statistics_.allocations;
    return VK_SUCCESS;
}

/// Keeps the first `spares` unused blocks that any resource could share.
void Allocator::removeUnusedBlocks(MemoryPool& pool, std::size_t spares) {
    std::erase_if(pool.blocks, [&](const std::unique_ptr<MemoryBlock>& block) {
        if (!block->free.unused()) return false;
        if (block->shared && spares > 0) return spares-- == 0;
        if (block->mapped != nullptr) ASAN_UNPOISON_MEMORY_REGION(block->mapped, block->bytes);
        statistics_.held -= block->bytes;
        --statistics_.allocations;
        return true;
    });
}

void ReturnMemory::operator()(Placement* placement) const {
    const std::unique_ptr<Placement> owned(placement);
    const std::lock_guard lock(allocator->mutex_);
    MemoryBlock& block = *placement->block;
    if (placement->mapped() != nullptr) ASAN_POISON_MEMORY_REGION(placement->mapped(), placement->bytes);
    block.free.give(placement->offset, placement->bytes);
    block.pool->used -= placement->bytes;
    allocator->statistics_.used -= placement->bytes;
    if (block.free.unused()) allocator->removeUnusedBlocks(*block.pool, block.pool->used > 0 ? 1 : 0);
}

MemoryStatistics Allocator::statistics() const {
    const std::lock_guard lock(mutex_);
    return statistics_;
}

}  // namespace lumulus::gpu
