#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace lumulus::cli {

/// True for a file name that ends so; upper and lower case are the same.
bool hasSuffix(const std::filesystem::path& path, std::string_view suffix);

/// Throws InputError where the name ends with none of the suffixes.
void requireSuffix(const std::filesystem::path& path, std::initializer_list<std::string_view> suffixes);

/// Text on stdout. Errors: Error where it cannot be written (a full disk, a closed pipe).
void printOut(std::string_view text);

}  // namespace lumulus::cli
