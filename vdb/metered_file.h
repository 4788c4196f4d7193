#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <utility>

#include "vdb/read_limits.h"

/// Reading a file in a way that can be ended (inside vdb/ only).
namespace lumulus::vdb {

/// A file whose reading can end between its pieces, and that foresees what the trees in it will take. OpenVDB has no
/// other way to stop: it makes a node for each mask that it reads, from a file that may hold little else. Flags of
/// tiles that are neither 0 nor 1 are refused: OpenVDB would read them into a bool.
class MeteredFile : public std::filebuf {
  public:
    /// `limits` must outlive this.
    MeteredFile(const std::filesystem::path& path, const ReadLimits& limits);

    enum class Leaves { withValues, withoutValues };
    /// Whether what is read next are masks of nodes to be made.
    void countMasks(bool count, Leaves leaves = Leaves::withValues) {
        counting_ = count;
        leaves_ = leaves;
        tile_ = {};
    }
    /// Foresees memory besides what masks tell. Errors: InputError where it is more than the limit.
    void foresee(std::uint64_t bytes);
    /// Notes what ended the reading besides what this throws itself.
    void noteEnd(std::exception_ptr end) { stopped_ = std::move(end); }
    /// Throws again what ended the reading, where that was not the file.
    void rethrow() const;

  protected:
    std::streamsize xsgetn(char* to, std::streamsize bytes) override;

  private:
    void checkTile(const char* read, std::streamsize bytes);

    /// How far the reading of a tile in the root of a tree has come, where it may be one.
    struct Tile {
        enum { nothing, coordinates, value } has = nothing;
        bool isFlag = false;  ///< the value, a byte, is 0 or 1
        bool isByte = false;  ///< the value
    };

    std::filesystem::path path_;
    const ReadLimits& limits_;
    bool counting_ = false;
    Leaves leaves_ = Leaves::withValues;
    Tile tile_;
    std::uint64_t foreseen_ = 0;  ///< bytes of memory
    std::exception_ptr stopped_;
};

}  // namespace lumulus::vdb
