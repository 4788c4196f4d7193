#pragma once

#include <concepts>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "scene/toml.h"

namespace lumulus::service {

/// Reads the keys of a TOML file, each once, and refuses those that nobody asked for.
/// Errors: InputError with file, line and key.
class ConfigReader {
  public:
    explicit ConfigReader(const std::filesystem::path& path);

    /// Folder of the file, at which relative paths start.
    const std::filesystem::path& folder() const { return folder_; }
    /// The place of a key for error messages: "service.toml:14, listen.tcp".
    std::string where(const std::string& key) const;

    std::optional<std::string> text(const std::string& key);
    std::optional<bool> boolean(const std::string& key);
    /// A path, made absolute; absent where the text is empty.
    std::optional<std::filesystem::path> path(const std::string& key);
    void number(const std::string& key, double& value, double low, double high);
    template <std::unsigned_integral Count>
    void count(const std::string& key, Count& value, std::uint64_t low, std::uint64_t high) {
        auto number = static_cast<double>(value);
        wholeNumber(key, number, static_cast<double>(low), static_cast<double>(high));
        value = static_cast<Count>(number);
    }
    void finish() const;

  private:
    toml::node_view<const toml::node> find(const std::string& key);
    void wholeNumber(const std::string& key, double& value, double low, double high);

    std::string source_;
    std::filesystem::path folder_;
    toml::table table_;
    std::set<std::string> known_;
};

}  // namespace lumulus::service
