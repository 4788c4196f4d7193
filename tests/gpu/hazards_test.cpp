#include "base/hazards.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace lumulus::gpu {
namespace {

using testing::StrEq;
using testing::ThrowsMessage;

constexpr std::uint64_t record = 1;
constexpr std::uint64_t other = 2;

Access reads(std::uint64_t resource) {
    return {resource, "records", true, false};
}
Access writes(std::uint64_t resource) {
    return {resource, "records", false, true};
}
Access updates(std::uint64_t resource) {
    return {resource, "records", true, true};
}

void use(HazardTracker& tracker, const std::string& command, Access access) {
    tracker.use(command, {&access, 1});
}

TEST(Hazards, ReadAfterWriteNeedsBarrier) {
    HazardTracker tracker;
    use(tracker, "trace", writes(record));
    EXPECT_THAT([&] { use(tracker, "gather", reads(record)); },
                ThrowsMessage<std::logic_error>(StrEq("missing barrier: gather reads records written by trace")));
    tracker.barrier();
    EXPECT_NO_THROW(use(tracker, "gather", reads(record)));
}

TEST(Hazards, WriteAfterWriteNeedsBarrier) {
    HazardTracker tracker;
    use(tracker, "clear", writes(record));
    EXPECT_THAT([&] { use(tracker, "trace", writes(record)); },
                ThrowsMessage<std::logic_error>(StrEq("missing barrier: trace writes records written by clear")));
    tracker.barrier();
    EXPECT_NO_THROW(use(tracker, "trace", writes(record)));
}

TEST(Hazards, WriteAfterReadNeedsBarrier) {
    HazardTracker tracker;
    use(tracker, "gather", reads(record));
    EXPECT_THAT([&] { use(tracker, "clear", writes(record)); },
                ThrowsMessage<std::logic_error>(StrEq("missing barrier: clear writes records read by gather")));
    tracker.barrier();
    EXPECT_NO_THROW(use(tracker, "clear", writes(record)));
}

TEST(Hazards, TwoAtomicUpdatesNeedBarrier) {
    HazardTracker tracker;
    use(tracker, "trace", updates(record));
    EXPECT_THROW(use(tracker, "trace", updates(record)), std::logic_error);
}

TEST(Hazards, ReadsTogetherAndOtherResourcesNeedNone) {
    HazardTracker tracker;
    use(tracker, "gather", reads(record));
    EXPECT_NO_THROW(use(tracker, "draw", reads(record)));
    EXPECT_NO_THROW(use(tracker, "clear", writes(other)));
}

TEST(Hazards, RefusedCommandLeavesNoTrace) {
    HazardTracker tracker;
    use(tracker, "trace", writes(record));
    const Access both[] = {writes(other), reads(record)};
    EXPECT_THROW(tracker.use("gather", both), std::logic_error);
    EXPECT_NO_THROW(use(tracker, "draw", reads(other)));
}

TEST(Hazards, OneCommandMayUseAResourceTwice) {
    HazardTracker tracker;
    const Access both[] = {reads(record), writes(record)};
    EXPECT_NO_THROW(tracker.use("in place", both));
}

}  // namespace
}  // namespace lumulus::gpu
