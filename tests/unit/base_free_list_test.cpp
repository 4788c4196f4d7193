#include "base/free_list.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <stdexcept>

namespace lumulus {
namespace {

TEST(FreeList, TakesTheSmallestRangeThatFits) {
    FreeList list(1000);
    EXPECT_EQ(list.take(100, 1), 0U);
    EXPECT_EQ(list.take(100, 1), 100U);
    EXPECT_EQ(list.take(50, 1), 200U);
    EXPECT_EQ(list.take(100, 1), 250U);
    list.give(0, 100);
    list.give(200, 50);
    EXPECT_EQ(list.take(50, 1), 200U);  // and not the start of the 100 that are free before it
    EXPECT_EQ(list.take(60, 1), 0U);
    EXPECT_EQ(list.take(651, 1), std::nullopt);
    EXPECT_EQ(list.take(650, 1), 350U);
}

TEST(FreeList, AlignmentLosesNothing) {
    FreeList list(256);
    EXPECT_EQ(list.take(1, 1), 0U);
    EXPECT_EQ(list.take(64, 64), 64U);
    EXPECT_EQ(list.freeBytes(), 256U - 65U);
    EXPECT_EQ(list.take(63, 1), 1U);  // the gap that alignment left
    EXPECT_EQ(list.take(65, 64), 128U);
    EXPECT_EQ(list.take(64, 64), std::nullopt);  // 63 bytes are left
}

TEST(FreeList, NeighboursMergeInAnyOrder) {
    FreeList list(300);
    for (int i = 0; i < 3; ++i) list.take(100, 1);
    EXPECT_EQ(list.ranges(), 0U);
    list.give(0, 100);
    list.give(200, 100);
    EXPECT_EQ(list.ranges(), 2U);
    EXPECT_FALSE(list.unused());
    list.give(100, 100);
    EXPECT_EQ(list.ranges(), 1U);
    EXPECT_TRUE(list.unused());
}

TEST(FreeList, WhatIsFreeCannotBeGivenBack) {
    FreeList list(300);
    list.take(100, 1);
    EXPECT_THROW(list.give(0, 101), std::logic_error);
    EXPECT_THROW(list.give(200, 50), std::logic_error);
    list.give(0, 100);
    EXPECT_THROW(list.give(0, 100), std::logic_error);
    EXPECT_THROW(FreeList(8).give(4, 8), std::logic_error);
}

/// Against a model that knows the taken ranges only: what is taken never overlaps, is aligned, and the free bytes add
/// up; a request that is refused has no gap of the model.
TEST(FreeList, RandomSequencesAgreeWithAModel) {
    constexpr std::uint64_t total = 1 << 16;
    std::mt19937 random(17);
    FreeList list(total);
    std::map<std::uint64_t, std::uint64_t> taken;  // size by offset
    std::uint64_t takenBytes = 0;
    int refused = 0;
    const auto hasGap = [&](std::uint64_t bytes, std::uint64_t alignment) {
        std::uint64_t begin = 0;
        for (const auto& [offset, size] : taken) {
            if ((begin + alignment - 1) / alignment * alignment + bytes <= offset) return true;
            begin = offset + size;
        }
        return (begin + alignment - 1) / alignment * alignment + bytes <= total;
    };
    for (int step = 0; step < 20000; ++step) {
        if (random() % 5 < 3) {
            const std::uint64_t bytes = 1 + random() % (1U << (random() % 12));
            const std::uint64_t alignment = 1U << (random() % 9);
            const auto offset = list.take(bytes, alignment);
            ASSERT_EQ(offset.has_value(), hasGap(bytes, alignment)) << step;
            refused += offset ? 0 : 1;
            if (!offset) continue;
            ASSERT_EQ(*offset % alignment, 0U) << step;
            const auto next = taken.lower_bound(*offset);
            ASSERT_TRUE(next == taken.end() || *offset + bytes <= next->first) << step;
            ASSERT_TRUE(next == taken.begin() || std::prev(next)->first + std::prev(next)->second <= *offset) << step;
            ASSERT_LE(*offset + bytes, total);
            taken.emplace(*offset, bytes);
            takenBytes += bytes;
        } else if (!taken.empty()) {
            auto range = taken.begin();
            std::advance(range, static_cast<std::ptrdiff_t>(random() % taken.size()));
            list.give(range->first, range->second);
            takenBytes -= range->second;
            taken.erase(range);
        }
        ASSERT_EQ(list.freeBytes(), total - takenBytes);
    }
    EXPECT_GT(refused, 100);  // the block was full at times
    for (const auto& [offset, bytes] : taken) list.give(offset, bytes);
    EXPECT_EQ(list.ranges(), 1U);
    EXPECT_EQ(list.take(total, 1), 0U);
}

}  // namespace
}  // namespace lumulus
