#include "mesh/accessor.h"

#include <fmt/format.h>

#include <cstring>

#include "mesh/gltf_file.h"

namespace lumulus::mesh {
namespace {

constexpr const char* exportAgain = "export it again";

template <typename T>
T valueAt(const unsigned char* place) {
    T value;
    std::memcpy(&value, place, sizeof(value));
    return value;
}

}  // namespace

std::span<const unsigned char> viewOf(const std::filesystem::path& file, const tinygltf::Model& model, int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size())
        failGltf(file, fmt::format("there is no buffer view {}", index), exportAgain);
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
        failGltf(file, fmt::format("buffer view {}: there is no buffer {}", index, view.buffer), exportAgain);
    const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        failGltf(file, fmt::format("buffer view {} reaches beyond its buffer of {} bytes", index, data.size()),
                 exportAgain);
    return std::span(data).subspan(view.byteOffset, view.byteLength);
}

Accessor::Accessor(const std::filesystem::path& file, const tinygltf::Model& model, int index, int components) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
        failGltf(file, fmt::format("there is no accessor {}", index), exportAgain);
    const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
    const auto fail = [&](const std::string& what) {
        failGltf(file, fmt::format("accessor {} {}", index, what), exportAgain);
    };
    if (accessor.sparse.isSparse) fail("is sparse, which is not read");
    if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
        fail(fmt::format("does not have {} numbers an element", components));
    const int width = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    if (width <= 0) fail("has numbers of no known type");
    type_ = accessor.componentType;
    normalized_ = accessor.normalized;
    width_ = static_cast<std::size_t>(width);
    data_ = viewOf(file, model, accessor.bufferView);
    const std::size_t element = width_ * static_cast<std::size_t>(components);
    stride_ = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    if (stride_ == 0) stride_ = element;
    if (stride_ < element) fail("has elements that overlap");
    count_ = accessor.count;
    if (accessor.byteOffset > data_.size()) fail("begins beyond its buffer view");
    data_ = data_.subspan(accessor.byteOffset);
    if (count_ > 0 && (data_.size() < element || count_ - 1 > (data_.size() - element) / stride_))
        fail(fmt::format("has {} elements, more than its buffer view", count_));
}

const unsigned char* Accessor::place(std::size_t element, int component) const {
    return data_.data() + element * stride_ + static_cast<std::size_t>(component) * width_;
}

bool Accessor::isIndex() const {
    return type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

float Accessor::number(std::size_t element, int component) const {
    const unsigned char* at = place(element, component);
    switch (type_) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return valueAt<float>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return static_cast<float>(*at) / (normalized_ ? 255.0F : 1.0F);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return static_cast<float>(valueAt<std::uint16_t>(at)) / (normalized_ ? 65535.0F : 1.0F);
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return static_cast<float>(valueAt<std::int8_t>(at)) / (normalized_ ? 127.0F : 1.0F);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return static_cast<float>(valueAt<std::int16_t>(at)) / (normalized_ ? 32767.0F : 1.0F);
        default:
            return 0.0F;
    }
}

std::uint32_t Accessor::index(std::size_t element) const {
    const unsigned char* at = place(element, 0);
    if (type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *at;
    if (type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return valueAt<std::uint16_t>(at);
    return valueAt<std::uint32_t>(at);
}

}  // namespace lumulus::mesh
