#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "fuzz/promise.h"
#include "service/protocol/requests.h"
#include "service/render/upload_store.h"
#include "service/values/request_error.h"
#include "service/values/sha256.h"

namespace lumulus::service::test {

using lumulus::test::promise;

constexpr std::uint64_t mostUploadBytes = 1000;

/// One step of a fuzzed upload, six bytes: who (bits 0 and 1), which file (bits 2 and 3), whether a byte is wrong (4),
/// whether another size is claimed (5), whether the client leaves instead (7); the offset and the length of the chunk
/// in 16 bits each; what is added to the size.
using UploadStep = std::span<const std::byte, 6>;

inline unsigned byteOf(UploadStep step, std::size_t at) {
    return std::to_integer<unsigned>(step[at]);
}

/// The message that carries the chunk of a step.
inline Message uploadMessage(UploadStep step) {
    static const std::array<std::string, 4> files{"", "ten bytes.", std::string(300, 'x'), std::string(600, 'y')};
    const unsigned flags = byteOf(step, 0);
    const std::string& file = files[flags >> 2U & 3U];
    const std::size_t offset = byteOf(step, 1) + 256U * byteOf(step, 2),
                      wanted = byteOf(step, 3) + 256U * byteOf(step, 4);
    std::string chunk = file.substr(std::min(offset, file.size()), wanted);
    if ((flags & 16U) != 0 && !chunk.empty()) chunk.back() = '?';
    const std::size_t size = file.size() + ((flags & 32U) != 0 ? byteOf(step, 5) : 0);
    const nlohmann::json fields{
        {"hash", sha256Hex(std::as_bytes(std::span(file)))}, {"size", size}, {"offset", offset}};
    const auto bytes = std::as_bytes(std::span(chunk));
    return {MessageType::upload, 1, fields.dump(), {bytes.begin(), bytes.end()}};
}

/// Checks a folder of uploads: whole files have their own hash as a name, and all together stay below the limit.
inline void checkUploads(const std::filesystem::path& folder, bool partsMayBe) {
    std::uintmax_t held = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        held += entry.file_size();
        if (partsMayBe && entry.path().extension() == ".part") continue;
        const std::string content = lumulus::test::readAll(entry.path());
        promise(entry.path().filename() == sha256Hex(std::as_bytes(std::span(content))) + ".vdb",
                "a whole file is named by its hash");
    }
    promise(held <= mostUploadBytes, "the folder has a limit");
}

}  // namespace lumulus::service::test

namespace lumulus::test {

/// Sends chunks of uploads in any order, from several clients, as bytes of the protocol say. Throws std::logic_error
/// where the folder of uploads does not keep its promises.
inline void feed(std::span<const std::byte> input) {
    using namespace service;
    constexpr std::size_t mostSteps = 64;
    const TemporaryFolder folder;
    const std::filesystem::path place = folder / "uploads";
    {
        UploadStore store(place, {service::test::mostUploadBytes, service::test::mostUploadBytes, 3600.0});
        for (std::size_t at = 0; at + 6 <= input.size() && at < 6 * mostSteps; at += 6) {
            const service::test::UploadStep step(input.subspan(at).first<6>());
            const unsigned flags = service::test::byteOf(step, 0);
            const ClientId client = 1U + (flags & 3U);
            if ((flags & 128U) != 0) {
                store.dropConnection(client);
            } else {
                try {
                    store.receive(client, client % 2 == 0 ? "even" : "odd",
                                  std::get<Upload>(parseRequest(service::test::uploadMessage(step), {})));
                } catch (const RequestError& error) {
                    promise(!error.code.empty(), "an error has a code");
                }
            }
            service::test::checkUploads(place, true);
        }
    }
    service::test::checkUploads(place, false);
}

}  // namespace lumulus::test
