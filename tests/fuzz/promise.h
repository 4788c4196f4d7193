#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "support/temporary_folder.h"

/// What the fuzz targets share. Each NAME_input.h defines `feed(input)`, for the fuzzer and for the replay of its
/// corpus.
namespace lumulus::test {

/// Throws std::logic_error where a promise is broken.
inline void promise(bool kept, const std::string& what) {
    if (!kept) throw std::logic_error("broken promise: " + what);
}

/// Writes `input` to a file and calls `read` with its path. It may be refused, by one line that names the file.
template <class Read>
void readOrRefuse(std::span<const std::byte> input, const std::string& name, const Read& read) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / name;
    writeAll(path, std::string(reinterpret_cast<const char*>(input.data()), input.size()));
    try {
        read(path);
    } catch (const InputError& error) {
        const std::string text = error.what();
        promise(text.find('\n') == std::string::npos, "an error is one line");
        promise(text.find(path.string()) != std::string::npos, "an error names the file");
    }
}

}  // namespace lumulus::test
