#pragma once

#include <glm/glm.hpp>
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
    std::uint64_t bytes() const { return bytes_; }  ///< of an image: all texels, tightly packed, x fastest

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

/// A picture (ivec2) or a volume (ivec3) of texels: sampled, stored to and transferred.
/// Always in layout GENERAL. The contents are undefined at first.
class Image : public Resource {
  public:
    /// Errors: Error where the extent is above the device's limit or memory runs out; std::logic_error for no texels
    /// and for a format that Lumulus does not use.
    Image(Context& context, std::string name, glm::ivec2 extent, VkFormat format);
    Image(Context& context, std::string name, glm::ivec3 extent, VkFormat format);

    VkImage handle() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }
    VkFormat format() const { return format_; }
    glm::ivec3 extent() const { return extent_; }   ///< z is 1 for a picture
    int dimensions() const { return dimensions_; }  ///< 2 or 3

  private:
    Image(Context& context, std::string name, glm::ivec3 extent, int dimensions, VkFormat format);

    glm::ivec3 extent_;
    int dimensions_;
    VkFormat format_;
    Owned<VkImage> image_;
    Owned<VkImageView> view_;
};

}  // namespace lumulus::gpu
