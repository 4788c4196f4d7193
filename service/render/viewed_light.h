#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "view/bounds.h"
#include "view/view.h"

namespace lumulus::service {

/// Remembers from where a scene was seen last: light towards another eye has to be made anew.
class ViewedLight {
  public:
    /// Of views drawn one after the other at a time [s] of the wind, those that need light towards an eye of their own.
    std::uint64_t missing(const std::vector<View>& views, const Bounds& clouds, double time) const;
    /// These views were drawn.
    void drawn(const std::vector<View>& views, const Bounds& clouds, double time);
    /// The light has changed.
    void forget() { eye_.reset(); }

  private:
    struct Eye {
        glm::dvec3 position, along;  // along: of parallel rays
        double time;
        bool operator==(const Eye&) const = default;
    };
    static Eye eyeOf(const View& view, const Bounds& clouds, double time);

    std::optional<Eye> eye_;
};

}  // namespace lumulus::service
