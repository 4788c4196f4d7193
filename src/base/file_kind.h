#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// What a file is, by its first bytes.
namespace lumulus {

/// As many bytes as the functions below look at.
inline constexpr std::size_t fileStartBytes = 512;

/// The first bytes of a regular file; empty for anything else, so that nothing is taken out of a pipe.
std::string fileStart(const std::filesystem::path& path);

bool isOpenVdb(std::string_view start);

/// A file or a bare grid of any version of NanoVDB.
bool isNanoVdb(std::string_view start);

/// A file of a kind that Lumulus does not read as a scene or a cloud.
struct ForeignFile {
    std::string_view name;  ///< "a gzip archive"
    std::string_view mend;  ///< "unpack it with gunzip"
};

/// The kind of a file that people give by mistake where a scene or a cloud is wanted: archives, pointers of Git LFS,
/// web pages, pictures and the like. None if the bytes are of no such kind.
std::optional<ForeignFile> foreignFile(std::string_view start);

}  // namespace lumulus
