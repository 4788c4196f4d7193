// AddressSanitizer ends the process where operator new cannot have the memory that it was asked for; damaged files ask
// for exabytes, and the loader answers the std::bad_alloc. So the tests with such files bring an operator new that
// throws.
#ifdef __has_feature  // clang
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif
#ifdef __SANITIZE_ADDRESS__

#include <cstdlib>
#include <new>

// RootNode::readTopology and InternalNode::readTopology of OpenVDB 10 lose the node in their hands when the stream
// throws; the stack of such a leak does not always reach their names.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libopenvdb.so";
}

extern "C" const char* __asan_default_options() {
    return "allocator_may_return_null=1";
}

void* operator new(std::size_t bytes) {
    void* memory = std::malloc(bytes > 0 ? bytes : 1);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
void* operator new[](std::size_t bytes) {
    return operator new(bytes);
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    return std::malloc(bytes > 0 ? bytes : 1);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
    return std::malloc(bytes > 0 ? bytes : 1);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}

#endif
