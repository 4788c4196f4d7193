#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "query/media.h"
#include "service/telemetry/memory_budget.h"
#include "service/values/results.h"

namespace lumulus::service {

/// A query that a client waits for.
struct QueryJob {
    ClientId client = 0;
    std::uint64_t id = 0;
    QueryRequest request;
    std::shared_ptr<MemoryBudget::Share> memory = {};  ///< that the request holds
    std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
};

/// Answers queries on one thread of low priority, beside the frames: one at a time, in the order in which they came.
/// The render thread hands over what a scene's light meets, as it is at that moment; from then on a query needs neither
/// scene nor device.
class QueryDesk {
  public:
    using Answer = std::function<void(ClientId, std::uint64_t id, Reply)>;

    /// `mutex` is the service's lock. `answer` takes an answer, with the lock held. Both must outlive this.
    QueryDesk(std::mutex& mutex, const Answer& answer);
    QueryDesk(const QueryDesk&) = delete;
    QueryDesk& operator=(const QueryDesk&) = delete;
    ~QueryDesk() { stop(); }

    // With the lock held:

    /// Errors: RequestError `busy` where four of the client wait.
    void submit(QueryJob job);
    bool anyAsked() const { return !asked_.empty(); }
    /// Those that wait for the render thread.
    std::vector<QueryJob> takeAsked() { return std::exchange(asked_, {}); }
    /// Hands over a query with what the light of its scene meets.
    void hand(QueryJob job, query::Media media, const glm::dvec3& directionTo);
    /// Whether a query of the client's was under way. It gets no other answer.
    bool cancel(ClientId client, std::uint64_t id);
    void removeClient(ClientId client);
    /// All that nobody has answered yet; they are forgotten.
    std::vector<QueryJob> takeAll();

    /// Ends the thread. Without the lock.
    void stop();

  private:
    struct Ready {
        QueryJob job;
        query::Media media;
        glm::dvec3 directionTo{0.0};
    };

    void loop();
    template <class Condition>
    std::vector<QueryJob> takeWhere(const Condition& condition);

    std::mutex& mutex_;
    const Answer& answer_;
    std::condition_variable wake_;
    std::vector<QueryJob> asked_;
    std::deque<Ready> ready_;
    std::optional<QueryJob> current_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace lumulus::service
