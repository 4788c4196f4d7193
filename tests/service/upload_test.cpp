// The folder of uploads: whole files under their hash, or nothing.
#include "service/render/upload_store.h"

#include <gtest/gtest.h>

#include "service/values/request_error.h"
#include "service/values/sha256.h"
#include "support/temporary_folder.h"

namespace lumulus::service {
namespace {

using test::TemporaryFolder;

class UploadTest : public testing::Test {
  protected:
    TemporaryFolder folder;
    std::filesystem::path place = folder / "uploads";

    static Upload chunk(const std::string& whole, std::uint64_t offset, std::size_t count) {
        const auto bytes = std::as_bytes(std::span(whole)).subspan(offset, count);
        return {sha256Hex(std::as_bytes(std::span(whole))), whole.size(), offset, {bytes.begin(), bytes.end()}};
    }
    static std::string code(UploadStore& store, const Upload& upload) {
        try {
            store.receive(1, upload);
        } catch (const RequestError& e) {
            return e.code;
        }
        return "taken";
    }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(place), {}));
    }
};

TEST_F(UploadTest, ChunksBecomeAFileNamedByItsHash) {
    UploadStore store(place, 1000);
    const std::string whole = "a cloud, in pieces";
    EXPECT_FALSE(store.receive(1, chunk(whole, 0, 7)).complete);
    EXPECT_EQ(store.receive(1, chunk(whole, 7, 5)).received, 12U);
    EXPECT_TRUE(store.receive(1, chunk(whole, 12, 6)).complete);
    EXPECT_EQ(test::readAll(place / (chunk(whole, 0, 0).hash + ".vdb")), whole);
    EXPECT_EQ(files(), 1U);
    EXPECT_TRUE(store.receive(2, chunk(whole, 0, 0)).complete);  // known already
    EXPECT_EQ(chunk("abc", 0, 0).hash, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(UploadTest, WhatIsWrongLeavesNothing) {
    UploadStore store(place, 1000);
    const std::string whole = "a cloud, in pieces";
    EXPECT_EQ(code(store, chunk(whole, 7, 5)), "bad_request");  // not the first
    store.receive(1, chunk(whole, 0, 7));
    EXPECT_EQ(code(store, chunk(whole, 8, 5)), "bad_request");  // a gap
    Upload other = chunk(whole, 7, 11);
    other.bytes[0] = std::byte{0};
    EXPECT_EQ(code(store, other), "bad_request");  // another hash
    EXPECT_EQ(files(), 0U);
    EXPECT_EQ(code(store, chunk(std::string(2000, 'x'), 0, 10)), "too_large");
    EXPECT_EQ(files(), 0U);
    store.receive(1, chunk(whole, 0, 7));
    EXPECT_EQ(files(), 1U);
    store.dropClient(1);
    EXPECT_EQ(files(), 0U);
}

TEST_F(UploadTest, AFullDiskIsAnError) {
    UploadStore store(place, 1U << 20U);
    const std::string whole(20000, 'x');
    std::filesystem::create_symlink("/dev/full", place / (chunk(whole, 0, 0).hash + "-1.part"));
    EXPECT_EQ(code(store, chunk(whole, 0, whole.size())), "storage");
    EXPECT_EQ(files(), 0U);
}

TEST_F(UploadTest, RemovesWhatAKilledServerLeft) {
    std::filesystem::create_directories(place);
    test::writeAll(place / "abc-1.part", "half");
    UploadStore store(place, 1000);
    EXPECT_EQ(files(), 0U);
}

}  // namespace
}  // namespace lumulus::service
