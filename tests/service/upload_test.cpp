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
    std::string owner = "127.0.0.1";
    UploadStore::Limits limits{1000, 1000, 3600.0};

    static Upload chunk(const std::string& whole, std::uint64_t offset, std::size_t count) {
        const auto bytes = std::as_bytes(std::span(whole)).subspan(offset, count);
        return {sha256Hex(std::as_bytes(std::span(whole))), whole.size(), offset, {bytes.begin(), bytes.end()}};
    }
    std::string code(UploadStore& store, const Upload& upload) const {
        try {
            store.receive(1, owner, upload);
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
    UploadStore store(place, limits);
    const std::string whole = "a cloud, in pieces";
    EXPECT_FALSE(store.receive(1, owner, chunk(whole, 0, 7)).complete);
    EXPECT_EQ(store.receive(1, owner, chunk(whole, 7, 5)).received, 12U);
    EXPECT_TRUE(store.receive(1, owner, chunk(whole, 12, 6)).complete);
    EXPECT_EQ(test::readAll(place / (chunk(whole, 0, 0).hash + ".vdb")), whole);
    EXPECT_EQ(files(), 1U);
    EXPECT_TRUE(store.receive(2, owner, chunk(whole, 0, 0)).complete);  // known already
    EXPECT_EQ(chunk("abc", 0, 0).hash, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(UploadTest, WhatIsWrongLeavesNothing) {
    UploadStore store(place, limits);
    const std::string whole = "a cloud, in pieces";
    EXPECT_EQ(code(store, chunk(whole, 7, 5)), "bad_request");  // not the first
    store.receive(1, owner, chunk(whole, 0, 7));
    EXPECT_EQ(code(store, chunk(whole, 8, 5)), "bad_request");  // a gap
    Upload other = chunk(whole, 7, 11);
    other.bytes[0] = std::byte{0};
    EXPECT_EQ(code(store, other), "bad_request");  // another hash
    EXPECT_EQ(files(), 0U);
    EXPECT_EQ(code(store, chunk(std::string(2000, 'x'), 0, 10)), "too_large");
    EXPECT_EQ(files(), 0U);
    store.receive(1, owner, chunk(whole, 0, 7));
    EXPECT_EQ(files(), 1U);
    store.dropConnection(1);
    EXPECT_EQ(files(), 0U);
}

TEST_F(UploadTest, AFullDiskIsAnError) {
    UploadStore store(place, {1U << 20U, 1U << 20U, 3600.0});
    const std::string whole(20000, 'x');
    std::filesystem::create_symlink("/dev/full", place / (chunk(whole, 0, 0).hash + "-1.part"));
    EXPECT_EQ(code(store, chunk(whole, 0, whole.size())), "storage");
    EXPECT_EQ(files(), 0U);
}

TEST_F(UploadTest, RemovesWhatAKilledServerLeft) {
    std::filesystem::create_directories(place);
    test::writeAll(place / "abc-1.part", "half");
    UploadStore store(place, limits);
    EXPECT_EQ(files(), 0U);
}

TEST_F(UploadTest, AnOwnerListsAndDeletesItsOwn) {
    UploadStore store(place, limits);
    const std::string whole = "a cloud, in pieces";
    const Upload upload = chunk(whole, 0, whole.size());
    EXPECT_TRUE(store.list(owner).empty());
    store.receive(1, owner, upload);
    ASSERT_EQ(store.list(owner).size(), 1U);
    EXPECT_EQ(store.list(owner)[0].hash, upload.hash);
    EXPECT_EQ(store.list(owner)[0].bytes, whole.size());
    EXPECT_NEAR(store.list(owner)[0].secondsLeft, 3600.0, 60.0);
    EXPECT_TRUE(store.list("another").empty());
    EXPECT_FALSE(store.remove("another", upload.hash));
    EXPECT_TRUE(store.receive(2, "another", upload).complete);  // it has the file too
    EXPECT_TRUE(store.remove(owner, upload.hash));
    EXPECT_EQ(files(), 1U);  // it is the other's still
    EXPECT_FALSE(store.remove(owner, upload.hash));
    EXPECT_TRUE(store.remove("another", upload.hash));
    EXPECT_EQ(files(), 0U);
}

TEST_F(UploadTest, AnOwnerHasAShare) {
    limits.ownerBytes = 30;
    UploadStore store(place, limits);
    const std::string first(20, 'x'), second(20, 'y');
    store.receive(1, owner, chunk(first, 0, 10));
    EXPECT_EQ(code(store, chunk(second, 0, 20)), "too_large");  // the rest of the first is counted
    store.receive(1, owner, chunk(first, 10, 10));
    EXPECT_EQ(code(store, chunk(second, 0, 20)), "too_large");
    EXPECT_TRUE(store.receive(2, "another", chunk(second, 0, 20)).complete);
    store.remove(owner, chunk(first, 0, 0).hash);
    EXPECT_EQ(code(store, chunk(std::string(20, 'z'), 0, 20)), "taken");
}

TEST_F(UploadTest, WhatNobodyUsesExpires) {
    UploadStore store(place, limits);
    const std::string old(20, 'x'), used(20, 'y');
    store.receive(1, owner, chunk(old, 0, 20));
    store.receive(1, owner, chunk(used, 0, 20));
    const auto now = UploadStore::FileClock::now();
    for (const std::string& text : {old, used})
        std::filesystem::last_write_time(place / (chunk(text, 0, 0).hash + ".vdb"), now - std::chrono::minutes(50));
    EXPECT_EQ(store.expire(now), 0U);
    store.receive(2, owner, chunk(used, 0, 0));  // asked for again
    EXPECT_EQ(store.expire(now + std::chrono::minutes(20)), 1U);
    ASSERT_EQ(store.list(owner).size(), 1U);
    EXPECT_EQ(store.list(owner)[0].hash, chunk(used, 0, 0).hash);
    EXPECT_EQ(files(), 1U);
}

}  // namespace
}  // namespace lumulus::service
