#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <stdexcept>

#include "gpu/context.h"

namespace lumulus::gpu {

/// What buffers and images have in common.
class Resource {
  public:
    const std::string& name() const { return name_; }
    /// Differs from that of every other resource of the context, also of those that are gone.
    std::uint64_t id() const { return allocation_->id; }
    std::uint64_t bytes() const { return bytes_; }  ///< of an image: all texels, tightly packed

  protected:
    Resource(std::string name, std::uint64_t bytes) : name_(std::move(name)), bytes_(bytes) {}

    std::string name_;
    std::uint64_t bytes_;
    Allocation allocation_;  // outlives what is bound to it
};

/// An array of bytes for shaders (storage), transfers and indirect dispatches.
class Buffer : public Resource {
  public:
    /// A size of 0 is made 16 bytes. The contents are undefined.
    /// Errors: Error where `bytes` is above the device's maxStorageBufferRange or memory runs out.
    Buffer(Context& context, std::string name, std::uint64_t bytes, Memory where);
    /// As above, of `count` texels, which shaders see as an imageBuffer (and may see as a plain buffer). On lavapipe
    /// its loads and stores are by vectors, those of a plain buffer by lanes. Errors: as above, and Error where `count`
    /// is above the device's maxTexelBufferElements.
    Buffer(Context& context, std::string name, std::uint64_t count, VkFormat texel, Memory where);

    VkBuffer handle() const { return buffer_.get(); }
    VkBufferView texels() const { return texels_.get(); }  ///< none for a plain buffer

    /// The whole values of type T that fit. Only for Memory::host (std::logic_error otherwise).
    template <class T>
    std::span<T> mapped() const {
        if (mapped_ == nullptr) throw std::logic_error("buffer " + name_ + " is not host memory");
        return {reinterpret_cast<T*>(mapped_), bytes_ / sizeof(T)};
    }

  private:
    Owned<VkBuffer> buffer_;
    Owned<VkBufferView> texels_;
    std::byte* mapped_ = nullptr;
};

/// The formats of images and texel buffers, with the bytes of a texel. Shaders store to all of them and sample all of
/// them, linearly but for the integers. Vulkan promises it with shaderStorageImageExtendedFormats, except for linear
/// filtering of 32-bit floats, which assess() asks for.
inline constexpr std::pair<VkFormat, std::uint64_t> texelSizes[] = {
    {VK_FORMAT_R8_UNORM, 1},      {VK_FORMAT_R16_UINT, 2},      {VK_FORMAT_B10G11R11_UFLOAT_PACK32, 4},
    {VK_FORMAT_R16_SFLOAT, 2},    {VK_FORMAT_R32_UINT, 4},      {VK_FORMAT_R16G16B16A16_SFLOAT, 8},
    {VK_FORMAT_R32_SFLOAT, 4},    {VK_FORMAT_R32G32_UINT, 8},   {VK_FORMAT_R32G32B32A32_SFLOAT, 16},
    {VK_FORMAT_R16G16_SFLOAT, 4}, {VK_FORMAT_R32G32_SFLOAT, 8}, {VK_FORMAT_R8G8B8A8_UNORM, 4},
};

struct ImageParts {
    int levels = 1;  ///< mip levels: each has half the extent of the one before, rounded down, at least 1
    int layers = 0;  ///< of an array of pictures; 0: no array
};

/// The number of mip levels from `extent` down to a single texel.
int mipLevels(glm::ivec3 extent);

/// One mip level of an image; for transfers, a layer or slice of it. Must not outlive the image, nor its being moved.
struct ImageLevel {
    const class Image* image = nullptr;
    int level = 0;
    std::optional<int> layer;

    glm::ivec3 extent() const;  ///< z is 1 for pictures
    int slices() const;         ///< depth of a volume; layers of an array
    std::uint64_t bytes() const;
};

/// A picture (ivec2), an array of pictures, or a volume (ivec3) of texels: sampled, stored to and transferred.
/// Always in layout GENERAL. The contents are undefined at first.
class Image : public Resource {
  public:
    /// Errors: Error where the extent or the layers are above the device's limit or memory runs out; std::logic_error
    /// for no texels, for more levels than mipLevels(), for an array of volumes, and for a format that is not in
    /// `texelSizes`.
    Image(Context& context, std::string name, glm::ivec2 extent, VkFormat format, ImageParts parts = {})
        : Image(context, std::move(name), glm::ivec3(extent, 1), 2, format, parts) {}
    Image(Context& context, std::string name, glm::ivec3 extent, VkFormat format, ImageParts parts = {})
        : Image(context, std::move(name), extent, 3, format, parts) {}

    VkImage handle() const { return image_.get(); }
    VkImageView view() const { return views_.front().get(); }  ///< all levels and layers
    VkImageView view(int level) const { return views_.at(static_cast<std::size_t>(level) + 1).get(); }
    VkFormat format() const { return format_; }
    glm::ivec3 extent() const { return extent_; }   ///< of level 0; z is 1 for a picture
    int dimensions() const { return dimensions_; }  ///< 2 or 3
    int levels() const { return parts_.levels; }
    bool isArray() const { return parts_.layers > 0; }
    int layers() const { return std::max(parts_.layers, 1); }

    /// Throws std::logic_error where the image has no such level or layer (of a volume: slice).
    ImageLevel level(int level, std::optional<int> layer = {}) const;

  private:
    Image(Context& context, std::string name, glm::ivec3 extent, int dimensions, VkFormat format, ImageParts parts);

    void addView(Context& context, const VkImageSubresourceRange& range);

    glm::ivec3 extent_;
    int dimensions_;
    VkFormat format_;
    ImageParts parts_;
    Owned<VkImage> image_;
    std::vector<Owned<VkImageView>> views_;  ///< of all levels, then of each
};

}  // namespace lumulus::gpu
