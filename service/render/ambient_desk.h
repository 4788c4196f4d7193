#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "service/render/query_desk.h"
#include "service/render/scene_store.h"

namespace lumulus::service {

/// Answers queries of ambient light on the render thread, which has the photons: a point at a time, of one query after
/// the other, so that frames come between two points.
class AmbientDesk {
  public:
    /// `mutex` is the service's lock, which guards all of this and `scenes`. `answer` takes an answer, with the lock
    /// held. All must outlive this.
    AmbientDesk(std::mutex& mutex, const SceneStore& scenes, const QueryDesk::Answer& answer)
        : mutex_(mutex), scenes_(scenes), answer_(answer) {}

    // With the lock held:

    /// Errors: RequestError `busy` where four of the client wait.
    void submit(QueryJob job);
    bool any() const { return !asked_.empty(); }
    /// Whether a point comes before the next frame: one has not come for a fifth of a second.
    bool presses(Clock::time_point now) const;
    /// Whether a query of the client's was under way. It gets no other answer.
    bool cancel(ClientId client, std::uint64_t id);
    void removeClient(ClientId client);
    /// All that nobody has answered yet; they are forgotten.
    std::vector<QueryJob> takeAll();

    /// Works out one point. On the render thread, without the lock.
    void step();

  private:
    struct Asked {
        QueryJob job;
        std::vector<float> values;  ///< of the points that are done
    };

    std::mutex& mutex_;
    const SceneStore& scenes_;
    const QueryDesk::Answer& answer_;
    std::deque<std::shared_ptr<Asked>> asked_;
    Clock::time_point lastStep_;
};

}  // namespace lumulus::service
