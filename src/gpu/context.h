#pragma once

#include <array>
#include <map>
#include <optional>

#include "gpu/allocator.h"

namespace lumulus::gpu {

struct ContextOptions {
    std::string device;       ///< index or part of a name; empty: the best device
    bool validation = false;  ///< Khronos validation layer with synchronisation validation
};

/// How a shader reads an image. Coordinates run from 0 to 1 over the image; the linear ones also mix mip levels.
enum class Sampler {
    none,         ///< a storage image: imageLoad and imageStore
    nearest,      ///< outside the image: 0. The only one for integer texels, which have no outside: use texelFetch
    linear,       ///< outside the image: 0
    linearClamp,  ///< outside the image: the texel at the edge
};

/// Bytes of pictures, volumes and lists that went from the host to the device and back.
struct Transfers {
    std::uint64_t uploaded = 0, downloaded = 0;
};

/// A compute pipeline and its layouts: programs of one code and one set of constants share it.
struct Pipeline {
    Owned<VkDescriptorSetLayout> setLayout;
    Owned<VkPipelineLayout> layout;
    Owned<VkPipeline> handle;
};

/// A command buffer with its pool and the fence of its submission.
struct CommandBuffer {
    Owned<VkCommandPool> pool;
    Owned<VkFence> fence;
    VkCommandBuffer handle = VK_NULL_HANDLE;
};

/// One Vulkan device with one queue, and what all passes share. Everything made from a context points at it, so it is
/// neither copied nor moved and must outlive them. Used by one thread at a time.
class Context {
  public:
    /// Errors: InputError for an unknown device; Error for no loader, no device, a missing feature or layer.
    explicit Context(const ContextOptions& options);
    Context(const Context&) = delete;
    ~Context();

    const DeviceInfo& device() const { return info_; }
    bool isCpu() const { return info_.type == "cpu"; }
    /// Warnings and errors of the validation layer so far.
    std::vector<std::string> validationMessages() const { return instance_.messages(); }
    /// GPU memory of all buffers and images.
    MemoryStatistics memory() const { return allocator_->statistics(); }
    /// Since the context was made: the copies of transfer.h, and the pictures that are read from host memory.
    const Transfers& transfers() const { return transfers_; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    std::uint64_t maxAllocationBytes() const { return maxAllocationBytes_; }
    std::uint32_t timestampBits() const { return timestampBits_; }

    VkDevice handle() const { return device_.get(); }
    VkPhysicalDevice physicalDevice() const { return physical_; }
    const VolkDeviceTable& api() const { return api_; }
    Allocator& allocator() { return *allocator_; }
    /// Null for Sampler::none.
    VkSampler sampler(Sampler kind) const { return samplers_[static_cast<std::size_t>(kind)].get(); }

    /// Makes an object of the device: `make` and `destroy` are its functions in api(), `name` is shown in messages of
    /// the validation layer and in debuggers, `bytes` is what it will take of memory, for the error.
    template <class T, class Info>
    Owned<T> create(VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*, T*),
                    decltype(Destroy<T>::call) destroy, const Info& info, VkObjectType type, const std::string& name,
                    std::uint64_t bytes = 0) const {
        T object = VK_NULL_HANDLE;
        checkMemory(make(handle(), &info, nullptr, &object), "making it", name, bytes);
        setObjectName(handle(), type, reinterpret_cast<std::uint64_t>(object), name);
        return {object, {handle(), destroy}};
    }

    CommandBuffer makeCommandBuffer(const std::string& name) const;
    /// Starts to record, ordered by a full barrier after all work submitted before.
    void begin(const CommandBuffer& commands) const;
    /// Ends the recording with a full barrier and hands it to the queue.
    void submit(const CommandBuffer& commands) const;
    void wait(const CommandBuffer& commands) const;
    /// All writes before are visible to everything after, on the device and the host.
    void recordFullBarrier(VkCommandBuffer commands) const;
    /// Calls `record` with a VkCommandBuffer, submits it and waits.
    template <class Record>
    void immediately(const Record& record) {
        begin(immediate_);
        record(immediate_.handle);
        submit(immediate_);
        wait(immediate_);
    }

    /// The pipeline of this key while a program holds it, else null: programs share what is compiled.
    std::weak_ptr<Pipeline>& pipeline(const std::string& key) { return pipelines_[key]; }

    /// The bookkeeping behind transfers().
    void addUploaded(std::uint64_t bytes) { transfers_.uploaded += bytes; }
    void addDownloaded(std::uint64_t bytes) { transfers_.downloaded += bytes; }

  private:
    struct DestroyDevice {
        const VolkDeviceTable* api;
        void operator()(VkDevice device) const { api->vkDestroyDevice(device, nullptr); }
    };

    void selectPhysicalDevice(const std::string& wanted);
    void openDevice();

    Transfers transfers_;
    Instance instance_;
    DeviceInfo info_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    std::uint64_t maxAllocationBytes_ = 0;
    std::uint32_t queueFamily_ = 0;
    std::uint32_t timestampBits_ = 0;
    VolkDeviceTable api_{};
    std::unique_ptr<VkDevice_T, DestroyDevice> device_{nullptr, DestroyDevice{&api_}};
    std::optional<Allocator> allocator_;
    VkQueue queue_ = VK_NULL_HANDLE;
    CommandBuffer immediate_;
    std::array<Owned<VkSampler>, 4> samplers_;  ///< by Sampler
    std::map<std::string, std::weak_ptr<Pipeline>> pipelines_;
};

}  // namespace lumulus::gpu
