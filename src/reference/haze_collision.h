#pragma once

#include <cstddef>

namespace lumulus::reference {

/// A collision with a particle of what fills the space around the clouds, fog or air.
struct HazeCollision {
    double metres = 0.0;
    std::size_t medium = 0;
};

}  // namespace lumulus::reference
