#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "service/render/frame_task.h"

namespace lumulus::service {

/// Counts the pictures that are drawn and not encoded yet, and keeps what encoding cost for the scenes to learn. The
/// caller locks.
class EncodingDesk {
  public:
    struct Cost {
        std::weak_ptr<SceneSlot> slot;
        Encoding encoding;
        EncodingReport report;
    };

    /// `most` pictures may be encoded at once.
    explicit EncodingDesk(std::size_t most) : most_(most) {}

    void begin() { ++pictures_; }
    void end() { --pictures_; }
    void note(Cost cost) { costs_.push_back(std::move(cost)); }
    /// What encoding cost since the last call.
    std::vector<Cost> takeCosts() { return std::exchange(costs_, {}); }

    bool empty() const { return pictures_ == 0; }
    bool full() const { return pictures_ >= most_; }
    /// Whether drawing has to wait now, and did not when this was called last.
    bool beginsToWait(bool wanted) {
        const bool waits = full() && wanted;
        return waits && !std::exchange(waits_, waits);
    }

  private:
    std::size_t most_;
    std::size_t pictures_ = 0;
    bool waits_ = false;
    std::vector<Cost> costs_;
};

}  // namespace lumulus::service
