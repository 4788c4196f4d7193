#pragma once

#include <exception>
#include <optional>
#include <string>

namespace lumulus::cli {

/// What a command starts threads for.
enum class ThreadUse {
    host,    ///< its own work on the CPU
    device,  ///< Vulkan too, whose driver may run on the CPU
    server,  ///< and sockets, encoders, loading
};

/// Bounds the threads of this process until it ends: those of oneTBB, and those of lavapipe where no device exists yet.
/// `threads`: absent for one a core. Errors: Error where the system lets the process start too few.
void limitThreads(std::optional<int> threads, ThreadUse use);

/// The text for a failure that nobody foresaw. A thread that the system refused, of ours or of oneTBB, is told as such,
/// with how to mend it.
std::string unforeseen(const std::exception& failure);

/// Whether the system refused a thread.
bool isThreadRefused(const std::exception& failure);

}  // namespace lumulus::cli
