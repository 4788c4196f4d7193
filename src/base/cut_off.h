#pragma once

#include <functional>

namespace lumulus {

/// When to give up a generation of photons that takes too long, and how long its steps may be. Both are asked between
/// the rounds of the walk, `due` after the first one: a generation that ends within one round is never given up.
struct CutOff {
    std::function<bool()> due;  ///< returns whether the time is over; empty: never
    /// What to do with photons on their way: drop the generation, so that the light of before stays (false), or keep it
    /// and count them as lost (true). Their light is missing then: for when a picture with too little light is better
    /// than one with none. Needs generations of few photons, so that all of them start in the first round.
    bool keepUnfinished = false;
    /// Returns the seconds that the next round should take, so that other work comes between two. Photons go the same
    /// ways, however long rounds are. Empty: rounds of some tenths of a second.
    std::function<double()> roundSeconds{};

    bool isDue() const { return due && due(); }
};

}  // namespace lumulus
