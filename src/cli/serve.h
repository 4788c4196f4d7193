#pragma once

#include <filesystem>

namespace lumulus::cli {

struct ServeOptions {
    std::filesystem::path config;
};

/// `lumulus serve`. Errors: InputError for a bad configuration, and addresses that are taken.
void runServe(const ServeOptions& options);

}  // namespace lumulus::cli
