#pragma once

#include <nanovdb/NanoVDB.h>
#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "base/interrupt.h"

/// From the bytes of a NanoVDB grid to an OpenVDB tree (inside vdb/ only: the headers cost seconds).
namespace lumulus::vdb {

/// Thrown where a grid leads out of its own bytes.
struct DamagedGrid : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The bytes of a NanoVDB grid, aligned as its nodes ask for. They are not set.
class NanoBytes {
  public:
    explicit NanoBytes(std::size_t size)
        : bytes_(static_cast<std::byte*>(::operator new(size, alignment))), size_(size) {}

    std::byte* data() const { return bytes_.get(); }
    std::size_t size() const { return size_; }

    /// The node that lies `offset` bytes from position `from`. Throws DamagedGrid if `bytes` bytes do not lie there.
    template <typename Node>
    const Node* node(std::int64_t from, std::int64_t offset, std::size_t bytes = sizeof(Node)) const {
        const auto size = static_cast<std::int64_t>(size_);
        if (bytes > size_ || offset < -size || offset > size) throw DamagedGrid("a node lies outside of the grid");
        const std::int64_t position = from + offset;
        if (position < 0 || position > size - static_cast<std::int64_t>(bytes))
            throw DamagedGrid("a node lies outside of the grid");
        if (position % NANOVDB_DATA_ALIGNMENT != 0) throw DamagedGrid("a node is not aligned");
        return reinterpret_cast<const Node*>(bytes_.get() + position);
    }

    std::int64_t positionOf(const void* node) const { return static_cast<const std::byte*>(node) - bytes_.get(); }

  private:
    static constexpr std::align_val_t alignment{NANOVDB_DATA_ALIGNMENT};
    struct Free {
        void operator()(std::byte* bytes) const { ::operator delete(bytes, alignment); }
    };
    std::unique_ptr<std::byte, Free> bytes_;
    std::size_t size_;
};

/// The head of a grid. Throws DamagedGrid if there are fewer bytes.
inline const nanovdb::GridData& nanoHead(const NanoBytes& bytes) {
    return *bytes.node<nanovdb::GridData>(0, 0);
}

/// The tree of a grid of scalars: its background and its active values as floats. Errors: DamagedGrid where a node lies
/// outside of the bytes or is shared, std::invalid_argument for a grid of another type, what `check` throws.
openvdb::FloatTree::Ptr nanoTree(const NanoBytes& bytes, const Check& check);

}  // namespace lumulus::vdb
