#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "service/values/requests.h"

namespace lumulus::service {

/// The folder of uploaded VDB files, each named by its SHA-256. A file that is not complete never stands under such a
/// name, and is removed with its client.
class UploadStore {
  public:
    /// Makes the folder, and removes what a killed server left. `mostBytes` of all files together.
    /// Errors: InputError where the folder cannot be made.
    UploadStore(std::filesystem::path folder, std::uint64_t mostBytes);
    ~UploadStore();

    struct Progress {
        std::uint64_t received = 0;
        bool complete = false;
    };
    /// Takes a chunk. Chunks come in order; one at offset 0 begins anew. A file that is there already is complete at
    /// once. Errors: RequestError `bad_request` (another offset was due, or the bytes have another hash), `too_large`
    /// (the folder is full), `storage` (the disk is full).
    Progress receive(ClientId client, const Upload& upload);
    void dropClient(ClientId client);

  private:
    struct Transfer;
    using Key = std::pair<ClientId, std::string>;

    Transfer& begin(const Key& key, const Upload& upload);
    std::uint64_t bytesHeld() const;

    std::filesystem::path folder_;
    std::uint64_t mostBytes_;
    std::map<Key, std::unique_ptr<Transfer>> transfers_;
};

}  // namespace lumulus::service
