#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>

#include "vdb/read_limits.h"

/// Reading a file in a way that can be ended (inside vdb/ only).
namespace lumulus::vdb {

/// A file whose reading can end between its pieces, and that foresees what the trees in it will take. OpenVDB has no
/// other way to stop: it makes a node for each mask that it reads, from a file that may hold little else.
class MeteredFile : public std::filebuf {
  public:
    /// `limits` must outlive this.
    MeteredFile(const std::filesystem::path& path, const ReadLimits& limits);

    enum class Leaves { withValues, withoutValues };
    /// Whether what is read next are masks of nodes to be made.
    void countMasks(bool count, Leaves leaves = Leaves::withValues) {
        counting_ = count;
        leaves_ = leaves;
    }
    /// Foresees memory besides what masks tell. Errors: InputError where it is more than the limit.
    void foresee(std::uint64_t bytes);
    /// Throws again what ended the reading, where that was not the file.
    void rethrow() const;

  protected:
    std::streamsize xsgetn(char* to, std::streamsize bytes) override;

  private:
    std::filesystem::path path_;
    const ReadLimits& limits_;
    bool counting_ = false;
    Leaves leaves_ = Leaves::withValues;
    std::uint64_t foreseen_ = 0;  ///< bytes of memory
    std::exception_ptr stopped_;
};

}  // namespace lumulus::vdb
