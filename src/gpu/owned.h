#pragma once

#include <volk.h>

#include <utility>

namespace lumulus::gpu {

/// Owns one object of a Vulkan device and destroys it with the function it was given; empty when moved from.
template <class T>
class Owned {
  public:
    using Destroy = void(VKAPI_PTR*)(VkDevice, T, const VkAllocationCallbacks*);

    Owned() = default;
    Owned(VkDevice device, T handle, Destroy destroy) : device_(device), handle_(handle), destroy_(destroy) {}
    Owned(Owned&& other) noexcept { swap(other); }
    Owned& operator=(Owned&& other) noexcept {
        Owned(std::move(other)).swap(*this);
        return *this;
    }
    ~Owned() {
        if (handle_ != VK_NULL_HANDLE) {
            destroy_(device_, handle_, nullptr);
        }
    }

    T get() const { return handle_; }

  private:
    void swap(Owned& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        std::swap(destroy_, other.destroy_);
    }

    VkDevice device_ = VK_NULL_HANDLE;
    T handle_ = VK_NULL_HANDLE;
    Destroy destroy_ = nullptr;
};

}  // namespace lumulus::gpu
