#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/image.h"
#include "query/clouds.h"
#include "scene/scene.h"
#include "service/values/results.h"
#include "view/view.h"

namespace lumulus::service {

class SceneSlot;

/// A picture whose error is to be measured, with all that paths through it need.
struct BiasJob {
    scene::Scene scene;                     ///< as it is now
    std::vector<query::CloudField> fields;  ///< of those of its clouds that are to be seen
    View view;                              ///< of the picture
    LayeredImage picture;
    std::uint64_t revision = 0;              ///< SceneSlot::revision() at that moment
    std::weak_ptr<SceneSlot> slot;           ///< whose picture it is
    std::shared_ptr<std::atomic<bool>> old;  ///< set where nobody wants to know any more
};

/// Measures how far pictures at rest are off in the mean, by unbiased paths (docs/proven-error.md), on one thread of
/// low priority: one picture at a time, for some seconds.
class BiasDesk {
  public:
    struct Found {
        std::weak_ptr<SceneSlot> slot;
        std::uint64_t revision = 0;
        std::optional<Bias> bias;  ///< absent where paths cannot tell
    };

    /// `told` is called on the thread when something was found.
    explicit BiasDesk(std::function<void()> told);
    BiasDesk(const BiasDesk&) = delete;
    BiasDesk& operator=(const BiasDesk&) = delete;
    ~BiasDesk() { stop(); }

    /// Whether there is nothing at hand.
    bool isFree() const;
    /// Begins with a picture, when free.
    void hand(BiasJob job);
    /// What was found since; none where nothing was.
    std::optional<Found> take();

    /// Ends the thread.
    void stop();

  private:
    void loop();

    std::function<void()> told_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::optional<BiasJob> waiting_;
    std::optional<Found> found_;
    bool working_ = false;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace lumulus::service
