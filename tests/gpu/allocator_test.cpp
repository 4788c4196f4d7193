#include "gpu/allocator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "base/error.h"
#include "gpu/memory.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::uint64_t KiB = 1ULL << 10U;
constexpr std::uint64_t MiB = 1ULL << 20U;

class AllocatorTest : public test::VulkanTest {
  protected:
    Allocation take(std::uint64_t bytes, Tiling tiling = Tiling::linear, Memory where = Memory::device) {
        return context.allocator().allocate("resource", {bytes, 64, ~0U}, where, tiling);
    }
    MemoryStatistics now() const { return context.memory(); }
};

TEST_F(AllocatorTest, SmallResourcesShareABlock) {
    const Allocation first = take(100);
    const Allocation second = take(100);
    EXPECT_EQ(first->memory(), second->memory());
    EXPECT_EQ(second->offset, 128U);
    EXPECT_EQ(now().used, 200U);
    EXPECT_EQ(now().held, Allocator::leastBlockBytes);
    EXPECT_EQ(now().allocations, 1U);
}

TEST_F(AllocatorTest, LinearAndOptimalResourcesShareNoBlock) {
    const Allocation buffer = take(100, Tiling::linear);
    const Allocation image = take(100, Tiling::optimal);
    EXPECT_NE(buffer->memory(), image->memory());
}

TEST_F(AllocatorTest, LargeResourceHoldsWhatItNeeds) {
    const std::uint64_t bytes = Allocator::leastBlockBytes / 2 + 64;
    const Allocation large = take(bytes);
    EXPECT_EQ(now().held, bytes);
    EXPECT_EQ(large->offset, 0U);
}

TEST_F(AllocatorTest, NothingIsHeldForNoResources) {
    std::vector<Allocation> many;
    for (int i = 0; i < 100; ++i) many.push_back(take(MiB, i % 2 == 0 ? Tiling::linear : Tiling::optimal));
    many.push_back(take(100 * MiB));
    EXPECT_EQ(now().used, 200 * MiB);
    std::shuffle(many.begin(), many.end(), std::mt19937(5));
    many.clear();
    EXPECT_EQ(now().used, 0U);
    EXPECT_EQ(now().held, 0U);
    EXPECT_EQ(now().allocations, 0U);
    EXPECT_EQ(now().peakUsed, 200 * MiB);
}

TEST_F(AllocatorTest, OneEmptyBlockStaysWhereThereAreResources) {
    const Allocation stays = take(MiB);
    std::vector<Allocation> many;
    for (int i = 0; i < 40; ++i) many.push_back(take(MiB));
    const std::uint32_t before = now().allocations;
    ASSERT_GT(before, 4U);
    many.clear();
    EXPECT_EQ(now().allocations, 2U);
    const std::uint64_t held = now().held;
    for (int i = 0; i < 10; ++i) take(2 * MiB);  // comes and goes within the block that was kept
    EXPECT_EQ(now().held, held);
}

TEST_F(AllocatorTest, IdsAreNeverUsedAgain) {
    std::set<std::uint64_t> ids;
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(ids.insert(take(64)->id).second);  // each in the place of the last
}

TEST_F(AllocatorTest, HostMemoryOfNeighboursIsApart) {
    std::vector<Allocation> many;
    for (int i = 0; i < 200; ++i) many.push_back(take(1000, Tiling::linear, Memory::host));
    for (std::size_t i = 0; i < many.size(); ++i) std::memset(many[i]->mapped(), static_cast<int>(i), 1000);
    for (std::size_t i = 0; i < many.size(); ++i)
        for (std::size_t k = 0; k < 1000; ++k) ASSERT_EQ(many[i]->mapped()[k], std::byte(i));
}

/// What is held above what is used stays small while resources of all sizes come, and is bounded while they come and
/// go; offsets within one VkDeviceMemory never overlap.
TEST_F(AllocatorTest, WasteIsBounded) {
    std::mt19937 random(3);
    std::vector<Allocation> living;
    for (int step = 0; step < 4000; ++step) {
        const std::uint64_t bytes = (1 + random() % 1024) << (random() % 11);  // to 1 MiB, 100 KiB in the mean
        living.push_back(take(bytes));
        ASSERT_LE(now().held, now().used * 5 / 4 + now().used / 20 + Allocator::leastBlockBytes) << step;
    }
    RecordProperty("held_over_used_grown",
                   std::to_string(static_cast<double>(now().held) / static_cast<double>(now().used)));
    for (int step = 0; step < 20000; ++step) {
        living[random() % living.size()] = nullptr;
        std::erase(living, nullptr);
        living.push_back(take((1 + random() % 1024) << (random() % 11)));
    }
    RecordProperty("held_over_used_mixed",
                   std::to_string(static_cast<double>(now().held) / static_cast<double>(now().used)));
    EXPECT_LE(now().held, now().used * 3 / 2);
    std::ranges::sort(living, {}, [](const Allocation& a) { return std::pair(a->block, a->offset); });
    for (std::size_t i = 1; i < living.size(); ++i) {
        const Placement& before = *living[i - 1];
        const Placement& after = *living[i];
        ASSERT_TRUE(before.block != after.block || before.offset + before.bytes <= after.offset);
    }
}

TEST_F(AllocatorTest, ThousandsOfResourcesTakeFewAllocations) {
    std::vector<Buffer> buffers;
    std::vector<Image> images;
    for (int i = 0; i < 10000; ++i)
        buffers.emplace_back(context, "buffer", (1 + static_cast<std::uint64_t>(i) % 32) * KiB, Memory::device);
    for (int i = 0; i < 2000; ++i) images.emplace_back(context, "image", glm::ivec2(64 + i % 64), VK_FORMAT_R32_SFLOAT);
    EXPECT_LT(now().allocations, 64U);
    EXPECT_LE(now().held, now().used * 4 / 3);
    RecordProperty("allocations", static_cast<int>(now().allocations));
    RecordProperty("used_MiB", static_cast<int>(now().used / MiB));
    RecordProperty("held_MiB", static_cast<int>(now().held / MiB));
    std::set<std::uint64_t> ids;
    for (const Buffer& buffer : buffers) ids.insert(buffer.id());
    for (const Image& image : images) ids.insert(image.id());
    EXPECT_EQ(ids.size(), 12000U);
}

/// A device with little memory: allocations fail where they exceed `bytes` together. Static, since a Vulkan function
/// has no other place for its state.
struct SmallDevice {
    static constexpr std::uint64_t bytes = 10 * MiB;
    static inline VolkDeviceTable real;
    static inline std::map<VkDeviceMemory, std::uint64_t> living;

    static VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo* info,
                                                   const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory) {
        std::uint64_t sum = info->allocationSize;
        for (const auto& [handle, size] : living) sum += size;
        if (sum > bytes) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        const VkResult result = real.vkAllocateMemory(device, info, callbacks, memory);
        if (result == VK_SUCCESS) living[*memory] = info->allocationSize;
        return result;
    }
    static VKAPI_ATTR void VKAPI_CALL free(VkDevice device, VkDeviceMemory memory,
                                           const VkAllocationCallbacks* callbacks) {
        living.erase(memory);
        real.vkFreeMemory(device, memory, callbacks);
    }
    static VolkDeviceTable table(const VolkDeviceTable& device) {
        real = device;
        VolkDeviceTable copy = device;
        copy.vkAllocateMemory = allocate;
        copy.vkFreeMemory = free;
        return copy;
    }
};

class SmallDeviceTest : public test::VulkanTest {
  protected:
    Allocation take(std::uint64_t bytes) {
        return small.allocate("density", {bytes, 64, ~0U}, Memory::device, Tiling::linear);
    }

    VolkDeviceTable table = SmallDevice::table(context.api());
    Allocator small{context.physicalDevice(), context.handle(), table, context.maxAllocationBytes()};
};

TEST_F(SmallDeviceTest, AFullDeviceNamesTheResourceAndTheBytes) {
    const Allocation first = take(8 * MiB);
    EXPECT_THAT([&] { take(3 * MiB); },
                ThrowsMessage<Error>(AllOf(HasSubstr("density"), HasSubstr(std::to_string(3 * MiB)),
                                           HasSubstr("VK_ERROR_OUT_OF_DEVICE_MEMORY"))));
    EXPECT_EQ(small.statistics().used, 8 * MiB);
}

TEST_F(SmallDeviceTest, WhereABlockDoesNotFitTheResourceMay) {
    const Allocation first = take(8 * MiB);
    const Allocation second = take(MiB);
    EXPECT_EQ(small.statistics().held, 9 * MiB);
}

TEST_F(SmallDeviceTest, AnEmptyBlockMakesRoomForAResource) {
    const Allocation stays = take(3 * MiB);
    take(MiB);
    EXPECT_EQ(small.statistics().held, 7 * MiB);  // the empty block is kept
    const Allocation large = take(6 * MiB);
    EXPECT_EQ(small.statistics().held, 9 * MiB);
}

}  // namespace
}  // namespace lumulus::gpu
