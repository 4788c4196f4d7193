#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace lumulus::bench {

/// The main of a benchmark of one scene: NAME SCENE [section.key=value…]. Exit code 2 for a wrong call, 1 where `run`
/// throws, with one line.
inline int benchMain(const char* name, int argc, char** argv,
                     void (*run)(const std::string& path, const std::vector<std::string>& overrides)) {
    if (argc < 2) {
        fmt::print(stderr, "usage: {} SCENE [section.key=value…]\n", name);
        return 2;
    }
    try {
        run(argv[1], {argv + 2, argv + argc});
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}: {}\n", name, e.what());
        return 1;
    }
    return 0;
}

}  // namespace lumulus::bench
