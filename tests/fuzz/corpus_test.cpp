// What a fuzzer has found interesting, again: without a fuzzer, in every build and under every sanitizer.
#include <gtest/gtest.h>

#include <filesystem>

#include LUMULUS_FUZZ_INPUT

namespace lumulus::test {
namespace {

TEST(Corpus, KeepsItsPromises) {
    std::size_t inputs = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(LUMULUS_CORPUS)) {
        if (!entry.is_regular_file()) continue;
        const std::string text = readAll(entry.path());
        EXPECT_NO_THROW(feed(std::as_bytes(std::span(text)))) << entry.path();
        ++inputs;
    }
    EXPECT_GE(inputs, 10U);
}

}  // namespace
}  // namespace lumulus::test
