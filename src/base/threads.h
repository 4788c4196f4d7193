#pragma once

namespace lumulus {

/// The number of threads, up to `wanted`, that the system lets this process have beside those it has. They are started
/// and ended to find out. No allocation, no exception: it may run before main().
int startableThreads(int wanted) noexcept;

}  // namespace lumulus
