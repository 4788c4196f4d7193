// libFuzzer's way into a parser: scripts/fuzz.sh builds it with the header of a target.
#include <cstdint>

#include LUMULUS_FUZZ_INPUT

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    lumulus::test::feed(std::as_bytes(std::span(data, size)));
    return 0;
}
