// Which scene is loaded next: the cheapest, each client's in their order, one large one at a time.
#include "service/render/load_queue.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.h"

namespace lumulus::service {
namespace {

using std::chrono::seconds;

class LoadQueueTest : public testing::Test {
  protected:
    LoadQueue queue;
    Clock::time_point now{};

    void push(ClientId client, std::uint64_t id) { queue.push({client, id, {}}, now); }
    /// Finds the sources of all that wait; the cost of load `id` is `costs[id]`.
    void findAll(const std::vector<double>& costs) {
        std::vector<LoadQueue::Entry> found;
        while (auto entry = queue.take({}, "", now)) {
            auto source = std::make_shared<SourcedScene>();
            source->key = std::to_string(entry->job.id);
            entry->source = source;
            entry->cost = costs[entry->job.id];
            found.push_back(std::move(*entry));
        }
        for (auto entry = found.rbegin(); entry != found.rend(); ++entry) queue.putBack(std::move(*entry));
    }
    /// Id of the load that comes next; −1 where there is none.
    int next(const std::vector<LoadQueue::Running>& running = {}, const std::string& held = "") {
        const auto entry = queue.take(running, held, now);
        return entry ? static_cast<int>(entry->job.id) : -1;
    }
};

constexpr double large = 2.0 * LoadQueue::largeCost;

TEST_F(LoadQueueTest, TheCheapestComesFirst) {
    for (const ClientId client : {1U, 2U, 3U}) push(client, client - 1);
    findAll({large, 5.0, 2.0});
    EXPECT_EQ(next(), 2);
    EXPECT_EQ(next(), 1);
    EXPECT_EQ(next(), 0);
    EXPECT_EQ(next(), -1);
}

TEST_F(LoadQueueTest, SourcesAreFoundBeforeAnythingIsLoaded) {
    push(1, 0);
    findAll({1.0});
    push(2, 1);
    EXPECT_EQ(next(), 1);
    EXPECT_EQ(next(), 0);
}

TEST_F(LoadQueueTest, LoadsOfAClientKeepTheirOrder) {
    push(1, 0);
    push(1, 1);
    push(2, 2);
    findAll({9.0, 1.0, 5.0});
    EXPECT_EQ(next(), 2);
    EXPECT_EQ(next({{1, "x", false}}), -1);  // one at a time
    EXPECT_EQ(next(), 0);
    EXPECT_EQ(next(), 1);
}

TEST_F(LoadQueueTest, LargeOnesComeOneAtATime) {
    push(1, 0);
    push(2, 1);
    findAll({large, LoadQueue::largeCost});
    const std::vector<LoadQueue::Running> running{{3, "x", true}};
    EXPECT_EQ(next(running), 1);
    EXPECT_EQ(next(running), -1);
    EXPECT_EQ(next(), 0);
}

TEST_F(LoadQueueTest, ASceneThatIsBeingLoadedIsWaitedFor) {
    push(1, 0);
    findAll({1.0});
    EXPECT_EQ(next({{2, "0", false}}), -1);
    EXPECT_EQ(next({}, "0"), -1);
    EXPECT_EQ(next({{2, "1", false}}, "1"), 0);
}

TEST_F(LoadQueueTest, WhatHasWaitedLongComesBeforeWhatIsCheap) {
    push(1, 0);
    now += seconds(11);
    push(2, 1);
    findAll({large, 1.0});
    EXPECT_EQ(next(), 0);
}

TEST_F(LoadQueueTest, ClientsThatLeaveWaitForNothing) {
    push(1, 0);
    push(2, 1);
    push(1, 2);
    EXPECT_EQ(queue.count(1), 2U);
    queue.removeClient(1);
    EXPECT_EQ(queue.count(1), 0U);
    ASSERT_EQ(queue.takeAll().size(), 1U);
    EXPECT_EQ(queue.count(2), 0U);
}

TEST_F(LoadQueueTest, DensitiesWaitAsScenesDoButNobodyWaitsForThem) {
    queue.push({1, 0, {}, {}, std::make_shared<const DensityWish>()}, now);
    push(1, 1);
    queue.push({2, 2, {}, {}, std::make_shared<const DensityWish>()}, now);
    EXPECT_EQ(queue.count(1), 1U) << "scenes alone";
    EXPECT_EQ(queue.count(2), 0U);
    findAll({2.0, 3.0, 1.0});
    EXPECT_EQ(next({{2, "x", false}}), 0) << "in its order, before the scene of its client";
    queue.push({1, 3, {}, {}, std::make_shared<const DensityWish>()}, now);
    const std::vector<LoadJob> taken = queue.takeDensities(1, {});
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken.front().id, 3U);
    EXPECT_EQ(next(), 2);
    EXPECT_EQ(next(), 1);
}

TEST_F(LoadQueueTest, CostsAreVoxelsAndBytes) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "a.vdb") << std::string(1000, 'x');
    scene::Scene scene;
    scene.clouds.resize(4);
    for (scene::Cloud& cloud : scene.clouds) cloud.resolution = 10;
    scene.clouds[1].vdb = scene.clouds[2].vdb = folder / "a.vdb";
    scene.clouds[3].resolution = 20;
    EXPECT_DOUBLE_EQ(loadCost(scene), 1000.0 + 1000.0 + 8000.0);  // a file that two clouds are of counts once
}

}  // namespace
}  // namespace lumulus::service
