#include <dlfcn.h>
#include <gtest/gtest.h>

/// Synchronisation validation (1.3.239) leaks some objects of its own with every command buffer; without it, or in any
/// other library, a leak fails the tests.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libVkLayer_khronos_validation.so";
}

/// The main of every test executable that uses Vulkan. The loader unloads drivers and layers with the last instance,
/// after which LeakSanitizer cannot tell their own tables from leaks, nor whose they are: so both stay loaded. Absent,
/// nothing happens.
int main(int argc, char** argv) {
    for (const char* library : {"libvulkan_lvp.so", "libVkLayer_khronos_validation.so"}) {
        dlopen(library, RTLD_NOW | RTLD_NODELETE);
    }
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
