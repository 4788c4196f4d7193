#pragma once

#include <cstddef>
#include <memory>

namespace lumulus::service {

/// The connections that one listener may have at once. On one thread.
class Seats {
  public:
    explicit Seats(std::size_t most) : most_(most) {}

    /// A seat, taken as long as the pointer lives, which may be longer than this; null where none is free.
    std::shared_ptr<void> take() {
        if (*taken_ >= most_) return nullptr;
        ++*taken_;
        return {taken_.get(), [taken = taken_](void*) { --*taken; }};
    }

  private:
    std::size_t most_;
    std::shared_ptr<std::size_t> taken_ = std::make_shared<std::size_t>(0);
};

}  // namespace lumulus::service
