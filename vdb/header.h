#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

namespace lumulus::vdb {

/// Checks that lengths of names and metadata in an OpenVDB file stay within the file, before OpenVDB reads them: it
/// fills memory for any length (up to 4 GiB) before it notices that the file is shorter. Positions are bytes from the
/// file's beginning. Errors of all checks: InputError. openvdb::initialize() has to have been called.
class HeadCheck {
  public:
    explicit HeadCheck(const std::filesystem::path& path);

    /// Names, types and values of metadata.
    void metadata(std::int64_t position);
    /// What describes a grid: its name, its type and the name of the grid whose tree it shares.
    void descriptor(std::int64_t position);
    /// A single text.
    void text(std::int64_t position);

  private:
    template <typename Steps>
    void walk(std::int64_t position, const Steps& steps);

    std::filesystem::path path_;
    std::ifstream in_;
    std::int64_t size_ = 0;
};

}  // namespace lumulus::vdb
