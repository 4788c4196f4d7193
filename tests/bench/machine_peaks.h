#pragma once

namespace lumulus::bench {

/// What all cores of this machine reach in a moment of measuring.
struct MachinePeaks {
    double operations = 0.0;  ///< float operations a second, a multiply-add counted as two
    double bytes = 0.0;       ///< a second, read and written, in arrays far larger than the caches
};

MachinePeaks measurePeaks();

}  // namespace lumulus::bench
