#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>

namespace lumulus::mesh {

/// Numbers of an accessor, whose place in its buffer has been checked.
class Accessor {
  public:
    /// Errors: InputError, as loadGltf(), for an accessor that does not exist, does not have `components` numbers an
    /// element, is sparse, or reaches beyond its buffer.
    Accessor(const std::filesystem::path& file, const tinygltf::Model& model, int index, int components);

    std::size_t count() const { return count_; }
    /// A number as a float; integers that are marked so are shares of their largest value.
    float number(std::size_t element, int component) const;
    /// An index of an accessor of unsigned integers.
    std::uint32_t index(std::size_t element) const;
    bool isIndex() const;
    bool isFloat() const { return type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }

  private:
    const unsigned char* place(std::size_t element, int component) const;

    std::span<const unsigned char> data_;
    std::size_t count_ = 0, stride_ = 0, width_ = 0;
    int type_ = 0;
    bool normalized_ = false;
};

/// The bytes of a buffer view. Errors: InputError, as loadGltf(), where it does not exist or reaches beyond its buffer.
std::span<const unsigned char> viewOf(const std::filesystem::path& file, const tinygltf::Model& model, int index);

}  // namespace lumulus::mesh
