#include "service/render/upload_store.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "base/error.h"
#include "service/values/request_error.h"
#include "service/values/sha256.h"

namespace lumulus::service {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view partSuffix = ".part", suffix = ".vdb";
constexpr std::size_t mostTransfers = 4;  // of one connection
constexpr std::size_t mostFiles = 256;    // of one owner

[[noreturn]] void failStorage() {
    throw RequestError("storage", "the upload cannot be stored: " + std::generic_category().message(errno));
}

}  // namespace

/// A file under way; removed where it does not get its final name.
struct UploadStore::Transfer {
    Transfer(fs::path to, std::string fileOwner, std::uint64_t fileSize)
        : path(std::move(to)),
          owner(std::move(fileOwner)),
          size(fileSize),
          file(std::fopen(path.c_str(), "wb"), std::fclose) {
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
        if (bytes.empty()) return;
        if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) failStorage();
        hash.update(bytes);
        received += bytes.size();
    }
    void finish(const fs::path& name) {
        if (std::fflush(file.get()) != 0 || ::fsync(::fileno(file.get())) != 0) failStorage();
        if (std::rename(path.c_str(), name.c_str()) != 0) failStorage();
    }

    fs::path path;
    std::string owner;
    std::uint64_t size;
    std::uint64_t received = 0;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file;
    Sha256 hash;
};

UploadStore::UploadStore(fs::path folder, Limits limits) : folder_(std::move(folder)), limits_(limits) {
    std::error_code ec;
    fs::create_directories(folder_, ec);
    if (!fs::is_directory(folder_))
        throw InputError("cannot make the folder of uploads: " + ec.message(), folder_.string(),
                         "change scenes.uploads");
    for (const auto& entry : fs::directory_iterator(folder_, ec))
        if (entry.path().extension() == partSuffix) fs::remove(entry.path(), ec);
}

UploadStore::~UploadStore() = default;

fs::path UploadStore::fileOf(const std::string& hash) const {
    return folder_ / (hash + std::string(suffix));
}

/// Of complete files, and of what others will be.
std::uint64_t UploadStore::bytesHeld() const {
    std::uint64_t bytes = 0;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder_, ec))
        if (entry.path().extension() != partSuffix) bytes += entry.is_regular_file(ec) ? entry.file_size(ec) : 0;
    for (const auto& [key, transfer] : transfers_) bytes += transfer->size;
    return bytes;
}

/// The same of one owner.
std::uint64_t UploadStore::bytesOf(const std::string& owner) const {
    std::uint64_t bytes = 0;
    for (const StoredUpload& upload : list(owner)) bytes += upload.bytes;
    for (const auto& [key, transfer] : transfers_) bytes += transfer->owner == owner ? transfer->size : 0;
    return bytes;
}

double UploadStore::secondsLeft(const fs::path& file, FileClock::time_point now) const {
    std::error_code ec;
    const auto used = fs::last_write_time(file, ec);
    return ec ? 0.0 : limits_.unusedSeconds - std::chrono::duration<double>(now - used).count();
}

UploadStore::Transfer& UploadStore::begin(const Key& key, const std::string& owner, const Upload& upload) {
    transfers_.erase(key);
    std::size_t others = 0;
    for (const auto& [other, transfer] : transfers_) others += other.first == key.first ? 1 : 0;
    if (others >= mostTransfers) throw RequestError("busy", "finish an upload before the next begins");
    if (list(owner).size() >= mostFiles)
        throw RequestError("too_large",
                           "one client may have " + std::to_string(mostFiles) + " uploads: delete some first");
    if (bytesOf(owner) + upload.size > limits_.ownerBytes)
        throw RequestError("too_large", "the uploads of one client hold " + std::to_string(limits_.ownerBytes) +
                                            " bytes at most: delete some first");
    if (bytesHeld() + upload.size > limits_.folderBytes)
        throw RequestError("too_large",
                           "the uploads of all clients hold " + std::to_string(limits_.folderBytes) + " bytes at most");
    const fs::path part = folder_ / (key.second + "-" + std::to_string(key.first) + std::string(partSuffix));
    return *transfers_.emplace(key, std::make_unique<Transfer>(part, owner, upload.size)).first->second;
}

UploadStore::Progress UploadStore::receive(ClientId connection, const std::string& owner, const Upload& upload) {
    const fs::path name = fileOf(upload.hash);
    std::error_code ec;
    if (fs::exists(name, ec)) {
        fs::last_write_time(name, FileClock::now(), ec);
        owners_[upload.hash].insert(owner);
        return {upload.size, true};
    }
    const Key key{connection, upload.hash};
    const auto known = transfers_.find(key);
    if (upload.offset != 0 &&
        (known == transfers_.end() || known->second->received != upload.offset || known->second->size != upload.size)) {
        const std::uint64_t due = known == transfers_.end() ? 0 : known->second->received;
        throw RequestError("bad_request", "the chunk at offset " + std::to_string(due) + " is due", "offset");
    }
    Transfer& transfer = upload.offset == 0 ? begin(key, owner, upload) : *known->second;
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
    owners_[upload.hash] = {owner};
    return {upload.size, true};
}

void UploadStore::dropConnection(ClientId connection) {
    std::erase_if(transfers_, [&](const auto& entry) { return entry.first.first == connection; });
}

std::vector<StoredUpload> UploadStore::list(const std::string& owner) const {
    std::vector<StoredUpload> uploads;
    const auto now = FileClock::now();
    for (const auto& [hash, owners] : owners_) {
        std::error_code ec;
        const std::uint64_t bytes = owners.contains(owner) ? fs::file_size(fileOf(hash), ec) : 0;
        if (owners.contains(owner) && !ec)
            uploads.push_back({hash, bytes, std::max(0.0, secondsLeft(fileOf(hash), now))});
    }
    return uploads;
}

bool UploadStore::remove(const std::string& owner, const std::string& hash) {
    const auto it = owners_.find(hash);
    if (it == owners_.end() || it->second.erase(owner) == 0) return false;
    if (!it->second.empty()) return true;
    owners_.erase(it);
    std::error_code ec;
    return fs::remove(fileOf(hash), ec);
}

std::size_t UploadStore::expire(FileClock::time_point now) {
    std::vector<fs::path> old;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(folder_, ec))
        if (entry.path().extension() == suffix && secondsLeft(entry.path(), now) <= 0.0) old.push_back(entry.path());
    for (const fs::path& file : old) {
        fs::remove(file, ec);
        owners_.erase(file.stem().string());
    }
    return old.size();
}

}  // namespace lumulus::service
