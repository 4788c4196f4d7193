#include "service/render/pending_changes.h"

#include <gtest/gtest.h>

namespace lumulus::service {
namespace {

PendingChanges::Change editBy(ClientId client) {
    PendingChanges::Change change;
    change.client = client;
    change.edits.emplace_back();
    return change;
}

TEST(PendingChangesTest, CloudsChangeUntilTheLastOfTheirChangesIsMade) {
    PendingChanges pending;
    pending.add(editBy(1));
    pending.add(editBy(1));
    EXPECT_TRUE(pending.editsOf(1));
    EXPECT_FALSE(pending.editsOf(2));
    const std::vector<PendingChanges::Change> taken = pending.takeAll();
    EXPECT_FALSE(pending.any());
    EXPECT_TRUE(pending.editsOf(1)) << "a cloud that the change adds is not there yet";
    pending.made(taken.at(0));
    EXPECT_TRUE(pending.editsOf(1));
    pending.made(taken.at(1));
    EXPECT_FALSE(pending.editsOf(1));
}

TEST(PendingChangesTest, TakingSomeLeavesTheOthersInOrder) {
    PendingChanges pending;
    for (const ClientId client : {1, 2, 1, 3}) pending.add(editBy(client));
    const auto taken = pending.takeWhere([](const PendingChanges::Change& change) { return change.client == 1; });
    ASSERT_EQ(taken.size(), 2u);
    const auto left = pending.takeAll();
    ASSERT_EQ(left.size(), 2u);
    EXPECT_EQ(left[0].client, 2u);
    EXPECT_EQ(left[1].client, 3u);
}

TEST(PendingChangesTest, ALightThatChangesIsNoChangeOfClouds) {
    PendingChanges pending;
    PendingChanges::Change light;
    light.client = 1;
    pending.add(light);
    EXPECT_TRUE(pending.anyOf(1));
    EXPECT_FALSE(pending.editsOf(1));
    const auto taken = pending.takeAll();
    pending.made(taken.front());
    EXPECT_FALSE(pending.editsOf(1));
}

}  // namespace
}  // namespace lumulus::service
