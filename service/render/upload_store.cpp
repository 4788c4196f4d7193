#include "service/render/upload_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "base/error.h"
#include "service/values/request_error.h"
#include "service/values/sha256.h"

namespace lumulus::service {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view partSuffix = ".part";
constexpr std::size_t mostTransfers = 4;  // of one client

[[noreturn]] void failStorage() {
    throw RequestError("storage", "the upload cannot be stored: " + std::generic_category().message(errno));
}

}  // namespace

/// A file under way; removed where it does not get its final name.
struct UploadStore::Transfer {
    Transfer(fs::path to, std::uint64_t fileSize)
        : path(std::move(to)), size(fileSize), file(std::fopen(path.c_str(), "wb"), std::fclose) {
        if (!file) failStorage();
    }
    Transfer(const Transfer&) = delete;
    Transfer& operator=(const Transfer&) = delete;
    ~Transfer() {
        file.reset();
        std::error_code ec;
        fs::remove(path, ec);
    }

    void append(std::span<const std::byte> bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) failStorage();
        hash.update(bytes);
        received += bytes.size();
    }
    void finish(const fs::path& name) {
        if (std::fflush(file.get()) != 0 || ::fsync(::fileno(file.get())) != 0) failStorage();
        if (std::rename(path.c_str(), name.c_str()) != 0) failStorage();
    }

    fs::path path;
    std::uint64_t size;
    std::uint64_t received = 0;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file;
    Sha256 hash;
};

UploadStore::UploadStore(fs::path folder, std::uint64_t mostBytes) : folder_(std::move(folder)), mostBytes_(mostBytes) {
    std::error_code ec;
    fs::create_directories(folder_, ec);
    if (!fs::is_directory(folder_))
        throw InputError("cannot make the folder of uploads: " + ec.message(), folder_.string(),
                         "change scenes.uploads");
    for (const auto& entry : fs::directory_iterator(folder_, ec))
        if (entry.path().extension() == partSuffix) fs::remove(entry.path(), ec);
}

UploadStore::~UploadStore() = default;

/// Of complete files, and of what others will be.
std::uint64_t UploadStore::bytesHeld() const {
    std::uint64_t bytes = 0;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder_, ec))
        if (entry.path().extension() != partSuffix) bytes += entry.is_regular_file(ec) ? entry.file_size(ec) : 0;
    for (const auto& [key, transfer] : transfers_) bytes += transfer->size;
    return bytes;
}

UploadStore::Transfer& UploadStore::begin(const Key& key, const Upload& upload) {
    transfers_.erase(key);
    std::size_t others = 0;
    for (const auto& [other, transfer] : transfers_) others += other.first == key.first ? 1 : 0;
    if (others >= mostTransfers) throw RequestError("busy", "finish an upload before the next begins");
    if (bytesHeld() + upload.size > mostBytes_)
        throw RequestError("too_large", "the folder of uploads holds " + std::to_string(mostBytes_) + " bytes at most");
    const fs::path part = folder_ / (key.second + "-" + std::to_string(key.first) + std::string(partSuffix));
    return *transfers_.emplace(key, std::make_unique<Transfer>(part, upload.size)).first->second;
}

UploadStore::Progress UploadStore::receive(ClientId client, const Upload& upload) {
    const fs::path name = folder_ / (upload.hash + ".vdb");
    std::error_code ec;
    if (fs::exists(name, ec)) return {upload.size, true};
    const Key key{client, upload.hash};
    const auto known = transfers_.find(key);
    if (upload.offset != 0 &&
        (known == transfers_.end() || known->second->received != upload.offset || known->second->size != upload.size)) {
        const std::uint64_t due = known == transfers_.end() ? 0 : known->second->received;
        throw RequestError("bad_request", "the chunk at offset " + std::to_string(due) + " is due", "offset");
    }
    Transfer& transfer = upload.offset == 0 ? begin(key, upload) : *known->second;
    try {
        transfer.append(upload.bytes);
        if (transfer.received < transfer.size) return {transfer.received, false};
        if (transfer.hash.hex() != upload.hash)
            throw RequestError("bad_request", "the bytes have another hash", "hash");
        transfer.finish(name);
    } catch (const RequestError&) {
        transfers_.erase(key);
        throw;
    }
    transfers_.erase(key);
    return {upload.size, true};
}

void UploadStore::dropClient(ClientId client) {
    std::erase_if(transfers_, [&](const auto& entry) { return entry.first.first == client; });
}

}  // namespace lumulus::service
