#pragma once

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "gpu/context.h"
#include "gpu/owned.h"

namespace lumulus::gpu {

enum class Memory {
    device,  ///< fast for the GPU; filled and read by transfer.h
    host     ///< mapped for as long as the buffer lives, coherent; cached where the device has it
};

/// Device memory of one resource, counted in Context::allocatedBytes().
class Allocation {
  public:
    Allocation() = default;
    /// Errors: Error naming the resource and the bytes where memory runs out.
    Allocation(Context& context, const std::string& resource, const VkMemoryRequirements& needs, Memory where);
    Allocation(Allocation&& other) noexcept;
    Allocation& operator=(Allocation&& other) noexcept;
    ~Allocation();

    VkDeviceMemory handle() const { return memory_.get(); }

  private:
    Context* context_ = nullptr;
    std::uint64_t bytes_ = 0;
    Owned<VkDeviceMemory> memory_;
};

/// An array of bytes for shaders (storage), transfers and indirect dispatches.
class Buffer {
  public:
    /// A size of 0 is made 16 bytes. The contents are undefined.
    /// Errors: Error where `bytes` is above the device's maxStorageBufferRange or memory runs out.
    Buffer(Context& context, std::string name, std::uint64_t bytes, Memory where);

    VkBuffer handle() const { return buffer_.get(); }
    std::uint64_t bytes() const { return bytes_; }
    const std::string& name() const { return name_; }
    std::uint64_t id() const { return id_; }  ///< unlike any other resource of the context
    bool isMapped() const { return mapped_ != nullptr; }

    /// The whole values of type T that fit. Only for Memory::host (std::logic_error otherwise).
    template <class T>
    std::span<T> mapped() {
        return {static_cast<T*>(mappedPointer()), bytes_ / sizeof(T)};
    }
    template <class T>
    std::span<const T> mapped() const {
        return {static_cast<const T*>(mappedPointer()), bytes_ / sizeof(T)};
    }

  private:
    void* mappedPointer() const {
        if (mapped_ == nullptr) {
            throw std::logic_error("buffer " + name_ + " is not host memory");
        }
        return mapped_;
    }

    std::string name_;
    std::uint64_t bytes_ = 0;
    std::uint64_t id_ = 0;
    Allocation allocation_;  // outlives the buffer bound to it
    Owned<VkBuffer> buffer_;
    void* mapped_ = nullptr;
};

/// A picture (ivec2) or a volume (ivec3) of texels: sampled, transferred, and stored to where the format allows it.
/// Always in layout GENERAL. The contents are undefined at first.
class Image {
  public:
    /// Errors: Error where the device cannot have such an image or memory runs out.
    Image(Context& context, std::string name, glm::ivec2 extent, VkFormat format);
    Image(Context& context, std::string name, glm::ivec3 extent, VkFormat format);

    VkImage handle() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }
    VkFormat format() const { return format_; }
    glm::ivec3 extent() const { return extent_; }   ///< z is 1 for a picture
    int dimensions() const { return dimensions_; }  ///< 2 or 3
    std::uint64_t bytes() const { return bytes_; }  ///< of all texels, tightly packed, x fastest
    bool isInteger() const;                         ///< read by usampler or isampler
    bool canFilter() const { return canFilter_; }   ///< by the linear samplers
    bool canStore() const { return canStore_; }     ///< by imageStore
    const std::string& name() const { return name_; }
    std::uint64_t id() const { return id_; }  ///< unlike any other resource of the context

  private:
    Image(Context& context, std::string name, glm::ivec3 extent, int dimensions, VkFormat format);
    VkImageCreateInfo describe(Context& context);

    std::string name_;
    glm::ivec3 extent_;
    int dimensions_;
    VkFormat format_;
    std::uint64_t bytes_;
    std::uint64_t id_;
    bool canFilter_ = false;
    bool canStore_ = false;
    Allocation allocation_;
    Owned<VkImage> image_;
    Owned<VkImageView> view_;
};

/// Bytes of one texel. Throws std::logic_error for a format that Lumulus does not use.
std::uint64_t texelBytes(VkFormat format);

}  // namespace lumulus::gpu
