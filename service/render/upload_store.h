#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "service/values/requests.h"
#include "service/values/results.h"

namespace lumulus::service {

/// The folder of uploaded VDB files, each named by its SHA-256. A file that is not complete never stands under such a
/// name, and is removed with its connection. A file belongs to those who have sent it, or would have; when the last of
/// them deletes it, or nobody has used it for long, it goes. Reads, writes and hashes, and so takes its time. Not for
/// several threads.
class UploadStore {
  public:
    using FileClock = std::filesystem::file_time_type::clock;

    struct Limits {
        std::uint64_t folderBytes = 0;  ///< of all files together
        std::uint64_t ownerBytes = 0;   ///< of those that belong to one owner
        double unusedSeconds = 0.0;     ///< for which a file is kept that nobody sends again or loads
    };

    /// Makes the folder, and removes what a killed server left. Errors: InputError where the folder cannot be made.
    UploadStore(std::filesystem::path folder, Limits limits);
    ~UploadStore();

    struct Progress {
        std::uint64_t received = 0;
        bool complete = false;
    };
    /// Takes a chunk from a connection of `owner`. Chunks come in order; one at offset 0 begins anew. A file that is
    /// there already is complete at once. Errors: RequestError `bad_request` (another offset was due, or the bytes have
    /// another hash), `too_large` (the folder is full, or the owner's share of it), `busy`, `storage` (the disk is
    /// full).
    Progress receive(ClientId connection, const std::string& owner, const Upload& upload);
    void dropConnection(ClientId connection);

    /// The files of an owner, by their hash.
    std::vector<StoredUpload> list(const std::string& owner) const;
    /// Deletes a file of an owner's. Returns false where the owner has no such file.
    bool remove(const std::string& owner, const std::string& hash);
    /// Deletes what has been unused for too long. Returns how many files.
    std::size_t expire(FileClock::time_point now);

  private:
    struct Transfer;
    using Key = std::pair<ClientId, std::string>;

    Transfer& begin(const Key& key, const std::string& owner, const Upload& upload);
    std::filesystem::path fileOf(const std::string& hash) const;
    std::uint64_t bytesHeld() const;
    std::uint64_t bytesOf(const std::string& owner) const;
    double secondsLeft(const std::filesystem::path& file, FileClock::time_point now) const;

    std::filesystem::path folder_;
    Limits limits_;
    std::map<Key, std::unique_ptr<Transfer>> transfers_;
    std::map<std::string, std::set<std::string>> owners_;  // of files, by hash
};

}  // namespace lumulus::service
