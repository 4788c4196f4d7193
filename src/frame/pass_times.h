#pragma once

#include <algorithm>
#include <vector>

#include "gpu/commands.h"

namespace lumulus::frame {

/// Adds the times of one submission to sums by the name of the pass, which stay in the order of their first pass.
inline void addTimes(std::vector<gpu::PassTime>& sums, const std::vector<gpu::PassTime>& times) {
    for (const gpu::PassTime& time : times) {
        const auto known = std::ranges::find(sums, time.name, &gpu::PassTime::name);
        if (known == sums.end())
            sums.push_back(time);
        else
            known->milliseconds += time.milliseconds;
    }
}

}  // namespace lumulus::frame
