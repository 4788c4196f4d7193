#include "gpu/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "gpu/context.h"
#include "support/vulkan_fixture.h"

namespace lumulus::gpu {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

DeviceInfo device(std::uint32_t index, const std::string& name, const std::string& type) {
    return {.name = name, .type = type, .driver = "", .apiVersion = "1.3.0", .index = index, .heapBytes = 0};
}

const std::vector<DeviceInfo>& someDevices() {
    static const std::vector<DeviceInfo> devices = {
        device(0, "llvmpipe (LLVM 15.0.6)", "cpu"), device(1, "Virtio Venus", "virtual"),
        device(2, "Radeon RX 7600", "discrete"), device(3, "Iris Xe", "integrated"), device(4, "GeForce", "discrete")};
    return devices;
}

/// Sets an environment variable for one scope.
class Environment {
  public:
    Environment(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    ~Environment() { unsetenv(name_); }

  private:
    const char* name_;
};

TEST(Device, AutomaticChoiceTakesTheFastestKindFirst) {
    EXPECT_THAT(chooseDevices(someDevices(), ""), ElementsAre(2, 4, 3, 1, 0));
}

TEST(Device, ChosenByIndex) {
    EXPECT_THAT(chooseDevices(someDevices(), "3"), ElementsAre(3));
    // index 15 is none, though the name of llvmpipe contains 15
    EXPECT_THROW(chooseDevices(someDevices(), "15"), InputError);
}

TEST(Device, ChosenByPartOfItsNameInAnyCase) {
    EXPECT_THAT(chooseDevices(someDevices(), "LLVMPIPE"), ElementsAre(0));
    EXPECT_THAT(chooseDevices(someDevices(), "radeon rx"), ElementsAre(2));
}

TEST(Device, UnknownOneIsAnErrorThatNamesTheOthers) {
    EXPECT_THAT([] { chooseDevices(someDevices(), "voodoo"); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("voodoo"), HasSubstr("2 = Radeon RX 7600 [discrete]"),
                                                HasSubstr("3 = Iris Xe [integrated]"))));
    EXPECT_THAT([] { Context({.device = "voodoo"}); }, ThrowsMessage<InputError>(HasSubstr("0 = ")));
}

TEST(Device, ListedDevicesAreDescribed) {
    const std::vector<DeviceInfo> devices = listDevices();
    ASSERT_FALSE(devices.empty());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        EXPECT_EQ(devices[i].index, i);
        EXPECT_FALSE(devices[i].name.empty());
        EXPECT_FALSE(devices[i].driver.empty());
        EXPECT_GT(devices[i].heapBytes, 1U << 20U);
        EXPECT_THAT(devices[i].apiVersion, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
    }
}

TEST(Device, ContextTakesTheNamedDevice) {
    const DeviceInfo first = listDevices().front();
    EXPECT_EQ(Context({.device = first.name}).device().name, first.name);
    const Context byIndex({.device = "0"});
    EXPECT_EQ(byIndex.device().name, first.name);
    EXPECT_EQ(byIndex.isCpu(), first.type == "cpu");
}

TEST(Device, NoDriverIsAnErrorWithItsMend) {
    const Environment none("VK_ICD_FILENAMES", "/nonexistent.json");
    EXPECT_THAT([] { listDevices(); }, ThrowsMessage<Error>(HasSubstr("mesa-vulkan-drivers")));
    EXPECT_THAT([] { Context({}); }, ThrowsMessage<Error>(HasSubstr("mesa-vulkan-drivers")));
}

TEST(Device, NoValidationLayerIsAnErrorWithItsMend) {
    const Environment none("VK_LAYER_PATH", "/nonexistent");
    EXPECT_THAT([] { Context({.device = "", .validation = true}); },
                ThrowsMessage<Error>(HasSubstr("vulkan-validationlayers")));
}

/// Puts another function in the place of a Vulkan entry point for one scope.
template <class Function>
class Replaced {
  public:
    Replaced(Function& entry, std::type_identity_t<Function> other)
        : entry_(entry), real_(std::exchange(entry, other)) {}
    Replaced(const Replaced&) = delete;
    Replaced& operator=(const Replaced&) = delete;
    ~Replaced() { entry_ = real_; }

  private:
    Function& entry_;
    Function real_;
};

class RequirementsTest : public testing::Test {
  protected:
    std::string missing() const { return assess(device).missing; }

    /// What is missing where the device has all features but those that `lack` switches off.
    std::string missingWithout(void (*lack)(VkPhysicalDeviceFeatures2&)) {
        static void (*change)(VkPhysicalDeviceFeatures2&) = nullptr;
        static PFN_vkGetPhysicalDeviceFeatures2 real = nullptr;
        change = lack;
        real = vkGetPhysicalDeviceFeatures2;
        const Replaced entry(vkGetPhysicalDeviceFeatures2,
                             [](VkPhysicalDevice of, VkPhysicalDeviceFeatures2* features) {
                                 real(of, features);
                                 change(*features);
                             });
        return missing();
    }

    Instance instance{false};
    VkPhysicalDevice device = instance.physicalDevices().front();
};

TEST_F(RequirementsTest, UsableDeviceLacksNothing) {
    const Suitability found = assess(device);
    EXPECT_EQ(found.missing, "");
    EXPECT_GT(found.timestampBits, 0U);
}

TEST_F(RequirementsTest, MissingFeatureIsNamed) {
    EXPECT_EQ(missingWithout([](auto& features) { features.features.shaderInt64 = VK_FALSE; }), "shaderInt64");
    EXPECT_EQ(missingWithout([](auto& features) {
                  auto* next = static_cast<VkPhysicalDeviceVulkan12Features*>(features.pNext);
                  ASSERT_EQ(next->sType, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
                  next->shaderBufferInt64Atomics = VK_FALSE;
              }),
              "shaderBufferInt64Atomics");
    EXPECT_EQ(missingWithout([](auto& features) {
                  auto* next = static_cast<VkPhysicalDeviceVulkan12Features*>(features.pNext);
                  auto* last = static_cast<VkPhysicalDeviceVulkan13Features*>(next->pNext);
                  ASSERT_EQ(last->sType, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
                  last->maintenance4 = VK_FALSE;
              }),
              "maintenance4");
}

TEST_F(RequirementsTest, OldVulkanIsNamed) {
    const Replaced entry(vkGetPhysicalDeviceProperties, [](VkPhysicalDevice, VkPhysicalDeviceProperties* properties) {
        properties->apiVersion = VK_API_VERSION_1_2;
    });
    EXPECT_EQ(missing(), "Vulkan 1.3");
}

TEST_F(RequirementsTest, MissingExtensionIsNamed) {
    const Replaced entry(vkEnumerateDeviceExtensionProperties,
                         [](VkPhysicalDevice, const char*, std::uint32_t* count, VkExtensionProperties*) {
                             *count = 0;
                             return VK_SUCCESS;
                         });
    EXPECT_EQ(missing(), "VK_KHR_push_descriptor");
}

TEST_F(RequirementsTest, MissingFilterIsNamed) {
    const Replaced entry(vkGetPhysicalDeviceFormatProperties,
                         [](VkPhysicalDevice, VkFormat format, VkFormatProperties* properties) {
                             *properties = {};
                             if (format == VK_FORMAT_R32_SFLOAT)
                                 properties->optimalTilingFeatures = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
                         });
    EXPECT_EQ(missing(), "linear filtering of 32-bit floats");
}

TEST_F(RequirementsTest, MissingQueueIsNamed) {
    const Replaced entry(vkGetPhysicalDeviceQueueFamilyProperties,
                         [](VkPhysicalDevice, std::uint32_t* count, VkQueueFamilyProperties* families) {
                             *count = 1;
                             if (families != nullptr) *families = {VK_QUEUE_COMPUTE_BIT, 1, 0, {}};  // no timestamps
                         });
    EXPECT_EQ(missing(), "a compute queue with timestamps");
}

TEST(Result, IsCheckedAndNamed) {
    EXPECT_NO_THROW(check(VK_SUCCESS, "vkQueueSubmit2"));
    EXPECT_THAT([] { check(VK_ERROR_DEVICE_LOST, "vkQueueSubmit2"); },
                ThrowsMessage<Error>(AllOf(HasSubstr("vkQueueSubmit2"), HasSubstr("VK_ERROR_DEVICE_LOST"))));
    EXPECT_THAT([] { checkMemory(VK_ERROR_OUT_OF_DEVICE_MEMORY, "vkAllocateMemory", "density", 12345); },
                ThrowsMessage<Error>(
                    AllOf(HasSubstr("density"), HasSubstr("12345 bytes"), HasSubstr("VK_ERROR_OUT_OF_DEVICE_MEMORY"))));
}

using ValidationTest = test::VulkanTest;

TEST_F(ValidationTest, MistakesAreCollectedAsMessages) {
    Context broken({.device = "", .validation = true});
    VkSamplerCreateInfo info{};  // without its type
    VkSampler sampler = VK_NULL_HANDLE;
    ASSERT_EQ(broken.api().vkCreateSampler(broken.handle(), &info, nullptr, &sampler), VK_SUCCESS);
    broken.api().vkDestroySampler(broken.handle(), sampler, nullptr);
    EXPECT_FALSE(broken.validationMessages().empty());
    EXPECT_TRUE(context.validationMessages().empty());
}

}  // namespace
}  // namespace lumulus::gpu
