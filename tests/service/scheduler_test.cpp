// Which picture comes next: turns, latest wins, streams by rate and change, clients that do not read.
#include "service/render/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "service/values/request_error.h"

namespace lumulus::service {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

class SchedulerTest : public testing::Test {
  protected:
    Scheduler scheduler{{3, 2, 2}};
    Clock::time_point now{};
    std::uint64_t revision = 1;

    void SetUp() override {
        for (const ClientId client : {1U, 2U}) scheduler.addClient(client);
    }
    Job frame(ClientId client, std::uint64_t id, std::uint32_t channel = 0, bool queue = false) {
        FrameRequest request;
        request.channel = channel;
        request.queue = queue;
        Job job;
        job.client = client;
        job.id = id;
        job.work = workOf(request);
        job.arrived = now;
        return job;
    }
    StartStream stream(double rate, bool onChange) {
        StartStream start;
        start.maxRate = rate;
        start.onChange = onChange;
        return start;
    }
    /// Id of the next picture, finished at once; 0 where there is none.
    std::uint64_t next() {
        const auto job = take();
        if (job) scheduler.done(*job);
        return job ? job->id : 0;
    }
    std::optional<Job> take() {
        return scheduler.take(now, [this](ClientId) { return revision; });
    }
    std::optional<Clock::time_point> due() {
        return scheduler.nextDue(now, [this](ClientId) { return revision; });
    }
};

TEST_F(SchedulerTest, ClientsTakeTurns) {
    for (const std::uint64_t id : {10U, 11U, 12U}) scheduler.submit(frame(1, id, 0, true));
    scheduler.submit(frame(2, 20));
    EXPECT_EQ(next(), 10U);
    EXPECT_EQ(next(), 20U);
    EXPECT_EQ(next(), 11U);
    EXPECT_EQ(next(), 12U);
    EXPECT_EQ(next(), 0U);
}

/// Who has had less of the renderer's time comes first. What a client does not ask for it does not save up.
TEST_F(SchedulerTest, ClientsShareTheTime) {
    scheduler.addClient(3);
    std::uint64_t id = 0;
    const auto serve = [&](const std::vector<ClientId>& asking) {
        for (const ClientId client : asking) scheduler.submit(frame(client, ++id));
        const std::optional<Job> job = take();
        scheduler.done(*job);
        const double cost = job->client == 1 ? 100.0 : 20.0;
        scheduler.charge(job->client, cost);
        EXPECT_EQ(scheduler.lastCost(job->client), cost);
        return job->client;
    };
    std::map<ClientId, int> frames;
    for (int i = 0; i < 60; ++i) ++frames[serve({1, 2})];
    EXPECT_EQ(frames[1], 10);
    EXPECT_EQ(frames[2], 50);
    EXPECT_EQ(serve({1, 2, 3}), 3U) << "it has had the least";
    frames.clear();
    for (int i = 0; i < 55; ++i) ++frames[serve({1, 2, 3})];
    EXPECT_NEAR(frames[1], 5, 1);
    EXPECT_NEAR(frames[2], frames[3], 1) << "it did not save up the time before";
    scheduler.charge(2, 60000.0);
    EXPECT_EQ(scheduler.lastCost(2), 100.0) << "the machine stood still";
    EXPECT_EQ(scheduler.lastCost(9), 0.0);
}

TEST_F(SchedulerTest, BesideAPictureOnlyOthersAreServed) {
    const auto revisionOf = [this](ClientId) { return revision; };
    const auto beside = [&](ClientId refused) {
        return scheduler.takeBeside(now, revisionOf, [refused](ClientId client) { return client != refused; });
    };
    for (const ClientId client : {1U, 2U}) scheduler.submit(frame(client, 10 * client, 0, true));
    scheduler.submit(frame(1, 11, 0, true));
    const auto first = take();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->id, 10U);
    EXPECT_FALSE(beside(2)) << "client 1 has a picture under way";
    const auto second = beside(9);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->id, 20U);
    EXPECT_TRUE(scheduler.done(*second));
    EXPECT_TRUE(scheduler.done(*first)) << "the one under way is not forgotten";
    EXPECT_EQ(next(), 11U);
}

TEST_F(SchedulerTest, TheLatestOfAChannelWins) {
    EXPECT_THAT(scheduler.submit(frame(1, 10, 0)), IsEmpty());
    EXPECT_THAT(scheduler.submit(frame(1, 11, 1)), IsEmpty());
    EXPECT_THAT(scheduler.submit(frame(1, 12, 0)), ElementsAre(10U));
    EXPECT_THAT(scheduler.submit(frame(2, 20, 0)), IsEmpty());
    EXPECT_EQ(next(), 11U);
    EXPECT_EQ(next(), 20U);
    EXPECT_EQ(next(), 12U);
}

TEST_F(SchedulerTest, QueuesAreBounded) {
    for (const std::uint64_t id : {1U, 2U, 3U}) scheduler.submit(frame(1, id, 0, true));
    EXPECT_THROW(scheduler.submit(frame(1, 4, 0, true)), RequestError);
    scheduler.startStream(2, 1, stream(10, false), now);
    scheduler.startStream(2, 2, stream(10, false), now);
    EXPECT_THROW(scheduler.startStream(2, 3, stream(10, false), now), RequestError);
    scheduler.startStream(2, 2, stream(20, false), now);  // the same one
    EXPECT_EQ(scheduler.streams(), 2U);
}

TEST_F(SchedulerTest, WhatIsPutBackGoesOnAfterTheOthers) {
    scheduler.submit(frame(1, 10));
    scheduler.submit(frame(2, 20));
    const auto first = take();
    ASSERT_TRUE(first && first->id == 10);
    EXPECT_TRUE(scheduler.putBack(*first));
    EXPECT_EQ(next(), 20U);
    const auto again = take();
    ASSERT_TRUE(again && again->id == 10);
    scheduler.submit(frame(1, 11));
    EXPECT_FALSE(scheduler.putBack(*again));  // superseded meanwhile
    EXPECT_EQ(next(), 11U);
}

TEST_F(SchedulerTest, StreamsKeepTheirRate) {
    scheduler.startStream(1, 7, stream(10, false), now);
    EXPECT_EQ(next(), 7U);
    EXPECT_EQ(next(), 0U);
    EXPECT_EQ(due(), now + milliseconds(100));
    now += milliseconds(100);
    EXPECT_EQ(next(), 7U);
    now += milliseconds(1000);  // late: no bunch of frames
    EXPECT_EQ(next(), 7U);
    EXPECT_EQ(next(), 7U);
    EXPECT_EQ(next(), 0U);
    EXPECT_TRUE(scheduler.stopStream(1, 7));
    EXPECT_FALSE(scheduler.stopStream(1, 7));
    EXPECT_FALSE(due());
}

TEST_F(SchedulerTest, ARhythmGoesOnHoweverLateAFrameIs) {
    const Clock::time_point begin = now;
    StartStream start;
    start.rhythm = Rhythm{40.0, 15.0};
    scheduler.startStream(1, 7, start, now);
    /// Number of the frame that is due after so many milliseconds, and the milliseconds from which it counts.
    const auto frameAt = [&](int after) -> std::pair<int, int> {
        now = begin + milliseconds(after);
        const auto job = take();
        if (!job) return {-1, -1};
        scheduler.done(*job);
        const auto since = std::chrono::duration_cast<milliseconds>(job->arrived - begin);
        return {static_cast<int>(job->number), static_cast<int>(since.count())};
    };
    const std::pair nothing(-1, -1);
    EXPECT_EQ(due(), begin + milliseconds(15));
    EXPECT_EQ(frameAt(14), nothing);
    EXPECT_EQ(frameAt(15), std::pair(0, 15));
    EXPECT_EQ(frameAt(58), std::pair(1, 55)) << "late by a little: the time counts from its moment";
    EXPECT_EQ(frameAt(185), std::pair(4, 175)) << "moments that have passed are left out, and count";
    EXPECT_EQ(frameAt(236), nothing) << "late by more than half: the next moment is waited for";
    EXPECT_EQ(due(), begin + milliseconds(255));
    scheduler.startStream(1, 7, start, now);  // new wishes, the same rhythm
    EXPECT_EQ(frameAt(255), std::pair(6, 255));
    start.rhythm->phase = 5.0;
    now = begin + milliseconds(260);
    scheduler.startStream(1, 7, start, now);
    EXPECT_EQ(frameAt(264), nothing);
    EXPECT_EQ(frameAt(265), std::pair(7, 265)) << "another rhythm counts on";
}

TEST_F(SchedulerTest, AStreamOfChangesSleepsWithoutThem) {
    scheduler.startStream(1, 7, stream(1000, true), now);
    EXPECT_EQ(next(), 7U);
    now += milliseconds(1000);
    EXPECT_EQ(next(), 0U);
    EXPECT_FALSE(due());  // nothing to wake up for
    ++revision;
    EXPECT_EQ(next(), 7U);
    now += milliseconds(1000);
    scheduler.startStream(1, 7, stream(1000, true), now);  // new wishes
    EXPECT_EQ(next(), 7U);
}

TEST_F(SchedulerTest, WhoDoesNotReadGetsNoMore) {
    scheduler.startStream(1, 7, stream(1000, false), now);
    for (int i = 0; i < 2; ++i) {
        const auto job = take();
        ASSERT_TRUE(job && job->id == 7);
        EXPECT_TRUE(scheduler.drawn(*job));
        EXPECT_TRUE(scheduler.encoded(*job));
        now += milliseconds(10);
    }
    EXPECT_EQ(next(), 0U);
    EXPECT_FALSE(due());
    scheduler.submit(frame(2, 20));
    EXPECT_EQ(next(), 20U);
    scheduler.frameSent(1);
    EXPECT_EQ(next(), 7U);
}

TEST_F(SchedulerTest, CancelsWhatWaitsAndFlagsWhatIsUnderWay) {
    scheduler.submit(frame(1, 10));
    EXPECT_TRUE(scheduler.cancel(1, 10));
    EXPECT_FALSE(scheduler.cancel(1, 10));
    scheduler.submit(frame(1, 11));
    const auto job = take();
    EXPECT_FALSE(scheduler.cancel(1, 11));
    EXPECT_TRUE(job->cancelled->load());
    EXPECT_FALSE(scheduler.cancel(9, 1));  // nobody of that name
}

TEST_F(SchedulerTest, AClientThatGoesTakesItsWorkAlong) {
    scheduler.submit(frame(1, 10));
    const auto job = take();
    scheduler.submit(frame(1, 11));
    scheduler.removeClient(1);
    EXPECT_TRUE(job->cancelled->load());
    EXPECT_FALSE(scheduler.putBack(*job));
    EXPECT_FALSE(scheduler.drawn(*job));
    EXPECT_FALSE(scheduler.encoded(*job));
    EXPECT_EQ(next(), 0U);
}

TEST_F(SchedulerTest, APictureThatIsEncodedCountsAsUnsentAndLeavesRoomForTheNext) {
    for (const std::uint64_t id : {10U, 11U, 12U}) scheduler.submit(frame(1, id, 0, true));
    const auto first = take();
    EXPECT_TRUE(scheduler.drawn(*first));
    const auto second = take();
    ASSERT_TRUE(second && second->id == 11);
    EXPECT_TRUE(scheduler.drawn(*second));
    EXPECT_FALSE(take());  // two are unsent
    EXPECT_TRUE(scheduler.encoded(*first));
    EXPECT_FALSE(take());
    scheduler.frameSent(1);
    EXPECT_EQ(next(), 12U);
}

TEST_F(SchedulerTest, NobodyWaitsForAPictureThatWasStoppedWhileItWasEncoded) {
    scheduler.startStream(1, 7, stream(10, false), now);
    const auto streamed = take();
    EXPECT_TRUE(scheduler.drawn(*streamed));
    scheduler.submit(frame(1, 10));
    const auto asked = take();
    EXPECT_TRUE(scheduler.drawn(*asked));
    EXPECT_TRUE(scheduler.stopStream(1, 7));
    EXPECT_FALSE(scheduler.cancel(1, 10));  // does not wait any more
    EXPECT_TRUE(streamed->cancelled->load() && asked->cancelled->load());
    EXPECT_FALSE(scheduler.encoded(*streamed));
    EXPECT_TRUE(scheduler.encoded(*asked));  // to be answered with the cancellation
    scheduler.submit(frame(1, 11));
    EXPECT_EQ(next(), 11U);  // the streamed one is not unsent
    const auto all = scheduler.takeCurrent();
    EXPECT_TRUE(all.empty());
}

TEST_F(SchedulerTest, WhatIsEncodedEndsWithTheRest) {
    scheduler.submit(frame(1, 10));
    const auto job = take();
    EXPECT_TRUE(scheduler.drawn(*job));
    const std::vector<Job> current = scheduler.takeCurrent();
    ASSERT_EQ(current.size(), 1U);
    EXPECT_EQ(current[0].id, 10U);
    EXPECT_TRUE(job->cancelled->load());
    EXPECT_FALSE(scheduler.encoded(*job));
}

TEST_F(SchedulerTest, WaitsForTheScene) {
    scheduler.setWaiting(1, true);
    scheduler.submit(frame(1, 10));
    EXPECT_EQ(next(), 0U);
    scheduler.setWaiting(1, false);
    EXPECT_EQ(next(), 10U);
}

TEST_F(SchedulerTest, AFrameTakesThePlaceOfAStreamsAndNotOfTheStream) {
    scheduler.startStream(1, 7, stream(10, true), now);
    const auto first = take();
    ASSERT_TRUE(first && first->stream);
    EXPECT_TRUE(scheduler.putBack(*first));
    EXPECT_THAT(scheduler.submit(frame(1, 10)), IsEmpty());  // nobody is told
    EXPECT_EQ(next(), 10U);
    now += milliseconds(100);
    const auto second = take();
    ASSERT_TRUE(second && second->stream);  // nothing changed, but it was never seen
    scheduler.submit(frame(1, 11));
    EXPECT_FALSE(scheduler.putBack(*second));
    scheduler.leaveOut(*second);
    EXPECT_EQ(next(), 11U);
    now += milliseconds(100);
    EXPECT_EQ(next(), 7U);
    now += milliseconds(100);
    EXPECT_EQ(next(), 0U);
}

TEST_F(SchedulerTest, NobodyWaitsForTheFrameOfAStreamThatWasStopped) {
    scheduler.startStream(1, 7, stream(10, false), now);
    const auto job = take();
    ASSERT_TRUE(job);
    EXPECT_TRUE(scheduler.stopStream(1, 7));
    EXPECT_FALSE(scheduler.done(*job));
}

TEST_F(SchedulerTest, EverythingEndsInParts) {
    for (const std::uint64_t id : {10U, 11U, 12U, 13U}) {
        const bool begins = id != 11U || take().has_value();  // 10 is under way
        ASSERT_TRUE(begins);
        scheduler.submit(frame(1, id, 0, true));
    }
    scheduler.startStream(2, 7, stream(10, false), now);
    const auto streamed = take();
    ASSERT_TRUE(streamed && streamed->stream);
    EXPECT_TRUE(scheduler.putBack(*streamed));
    EXPECT_EQ(scheduler.endStreams().size(), 1U);
    EXPECT_EQ(scheduler.streams(), 0U);
    EXPECT_EQ(scheduler.takeQueued().size(), 3U);
    EXPECT_FALSE(scheduler.hasQueued());
    const std::vector<Job> current = scheduler.takeCurrent();
    ASSERT_EQ(current.size(), 1U);
    EXPECT_EQ(current[0].id, 10U);
    EXPECT_TRUE(current[0].cancelled->load());
    EXPECT_FALSE(scheduler.done(current[0]));
    EXPECT_FALSE(scheduler.putBack(current[0]));
    EXPECT_EQ(next(), 0U);
}

}  // namespace
}  // namespace lumulus::service
