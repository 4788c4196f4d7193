#include "gpu/memory.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "base/error.h"
#include "gpu/transfer.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using MemoryTest = test::VulkanTest;

template <class T>
std::vector<T> counting(std::size_t count) {
    std::vector<T> values(count);
    std::iota(values.begin(), values.end(), T(1));
    return values;
}

TEST_F(MemoryTest, EmptyBufferIsMade16Bytes) {
    EXPECT_EQ(Buffer(context, "empty", 0, Memory::device).bytes(), 16U);
}

TEST_F(MemoryTest, BufferAboveTheLimitIsAnErrorWithBothNumbers) {
    const std::uint64_t limit = context.limits().maxStorageBufferRange;
    EXPECT_THAT([&] { Buffer(context, "records", limit + 1, Memory::device); },
                ThrowsMessage<Error>(AllOf(HasSubstr("records"), HasSubstr(std::to_string(limit)),
                                           HasSubstr(std::to_string(limit + 1)))));
}

TEST_F(MemoryTest, ImageAboveTheLimitIsAnErrorWithBothNumbers) {
    ASSERT_LT(context.limits().maxImageDimension3D, 1U << 20U);
    EXPECT_THAT(
        [&] { Image(context, "density", glm::ivec3(1 << 20, 1, 1), VK_FORMAT_R8_UNORM); },
        ThrowsMessage<Error>(AllOf(HasSubstr("density"), HasSubstr("1048576x1x1"),
                                   HasSubstr(fmt::format("limit of {}x", context.limits().maxImageDimension3D)))));
}

TEST_F(MemoryTest, RunningOutOfMemoryNamesTheResourceAndTheBytes) {
    const VkMemoryRequirements needs{context.maxAllocationBytes() + 1, 16, ~0U};
    EXPECT_THAT([&] { context.allocator().allocate("photons", needs, Memory::device, Tiling::linear); },
                ThrowsMessage<Error>(AllOf(HasSubstr("photons"), HasSubstr(std::to_string(needs.size)),
                                           HasSubstr("VK_ERROR_OUT_OF_DEVICE_MEMORY"))));
}

TEST_F(MemoryTest, AllocatedBytesFollowTheResources) {
    const std::uint64_t before = context.memory().used;
    {
        Buffer first(context, "first", 1000, Memory::device);
        const std::uint64_t one = context.memory().used;
        EXPECT_GE(one, before + 1000);
        const Buffer moved = std::move(first);
        EXPECT_EQ(context.memory().used, one);
        const Image image(context, "image", glm::ivec3(8, 8, 8), VK_FORMAT_R32_SFLOAT);
        EXPECT_GE(context.memory().used, one + 8 * 8 * 8 * 4);
    }
    EXPECT_EQ(context.memory().used, before);
}

TEST_F(MemoryTest, MoveAssignmentReleasesTheOldMemory) {
    const std::uint64_t before = context.memory().used;
    {
        Buffer target(context, "old", 4096, Memory::device);
        const std::vector<std::uint32_t> values = {7, 8};
        Buffer source(context, "new", 8, Memory::device);
        upload(context, source, values);
        const std::uint64_t both = context.memory().used;
        target = std::move(source);
        EXPECT_LT(context.memory().used, both);
        EXPECT_EQ(target.name(), "new");
        EXPECT_EQ(download<std::uint32_t>(context, target), values);
    }
    EXPECT_EQ(context.memory().used, before);
}

TEST_F(MemoryTest, HostBufferIsMappedAndDeviceBufferIsNot) {
    Buffer host(context, "host", 12, Memory::host);
    ASSERT_EQ(host.mapped<std::uint32_t>().size(), 3U);
    host.mapped<std::uint32_t>()[2] = 9;
    EXPECT_EQ(download<std::uint32_t>(context, host)[2], 9U);
    Buffer device(context, "device", 12, Memory::device);
    EXPECT_THROW(device.mapped<std::uint32_t>(), std::logic_error);
}

TEST_F(MemoryTest, LargeBufferGoesInChunks) {
    const std::vector<std::uint32_t> values = counting<std::uint32_t>(2 * stagingBytes / 4 + 1001);
    Buffer buffer(context, "large", values.size() * 4, Memory::device);
    upload(context, buffer, values);
    EXPECT_TRUE(download<std::uint32_t>(context, buffer) == values);
}

TEST_F(MemoryTest, LargeVolumeGoesInSlices) {
    const glm::ivec3 extent(300, 200, 100);  // 24 MB, which is no multiple of the chunk
    const std::vector<float> values = counting<float>(300 * 200 * 100);
    Image image(context, "volume", extent, VK_FORMAT_R32_SFLOAT);
    upload(context, image, values);
    EXPECT_TRUE(download<float>(context, image) == values);
}

TEST_F(MemoryTest, SliceAboveTheChunkGoesWhole) {
    const std::vector<std::uint32_t> values = counting<std::uint32_t>(2050 * 2100);  // 17 MB in one slice
    Image image(context, "picture", glm::ivec2(2050, 2100), VK_FORMAT_R32_UINT);
    upload(context, image, values);
    EXPECT_TRUE(download<std::uint32_t>(context, image) == values);
}

TEST_F(MemoryTest, TransferOfTheWrongSizeIsRefused) {
    const std::vector<std::uint32_t> values(5);
    Buffer buffer(context, "small", 16, Memory::device);
    EXPECT_THROW(upload(context, buffer, values), std::logic_error);
    Image image(context, "image", glm::ivec3(2, 1, 1), VK_FORMAT_R32_UINT);
    EXPECT_THROW(upload(context, image, values), std::logic_error);
}

TEST_F(MemoryTest, NothingUploadedIsNothingDone) {
    Buffer buffer(context, "empty", 0, Memory::device);
    EXPECT_NO_THROW(upload(context, buffer, std::vector<float>{}));
}

TEST_F(MemoryTest, FormatWithoutAKnownSizeIsRefused) {
    EXPECT_THROW(Image(context, "depth", glm::ivec2(4, 4), VK_FORMAT_D32_SFLOAT), std::logic_error);
    EXPECT_THROW(Image(context, "nothing", glm::ivec2(0, 4), VK_FORMAT_R8_UNORM), std::logic_error);
}

using RoundTrip = std::pair<VkFormat, std::uint64_t>;

class FormatTest : public test::VulkanTest, public testing::WithParamInterface<RoundTrip> {};

TEST_P(FormatTest, VolumeComesBackAsItWas) {
    const glm::ivec3 extent(7, 5, 3);  // odd, so that rows are not aligned
    const auto& [format, texelBytes] = GetParam();
    const std::size_t bytes = 7 * 5 * 3 * texelBytes;
    std::vector<std::uint8_t> values(bytes);
    for (std::size_t i = 0; i < bytes; ++i) {
        values[i] = static_cast<std::uint8_t>(i % 59);  // no NaN among the half and single floats
    }
    Image image(context, "volume", extent, format);
    EXPECT_EQ(image.bytes(), bytes);
    upload(context, image, values);
    EXPECT_EQ(download<std::uint8_t>(context, image), values);
}

INSTANTIATE_TEST_SUITE_P(Formats, FormatTest, testing::ValuesIn(texelSizes));

}  // namespace
}  // namespace lumulus::gpu
