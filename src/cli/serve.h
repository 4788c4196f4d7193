#pragma once

#include <filesystem>

namespace lumulus::cli {

struct ServeOptions {
    std::filesystem::path config;
};

/// Runs `lumulus serve`. Errors: InputError for a bad configuration and for addresses that are in use.
void runServe(const ServeOptions& options);

}  // namespace lumulus::cli
