// libFuzzer's way into the session: scripts/fuzz_session.sh builds and runs it.
#include <cstddef>
#include <cstdint>

#include "fuzz/session_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    lumulus::service::test::feedSession(std::as_bytes(std::span(data, size)));
    return 0;
}
