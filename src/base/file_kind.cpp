#include "base/file_kind.h"

#include <array>
#include <fstream>
#include <system_error>

namespace lumulus {
namespace {

using namespace std::string_view_literals;

struct Signature {
    std::size_t at;
    std::string_view bytes;
    ForeignFile file;
};

constexpr std::string_view convert = "convert it to OpenVDB";
constexpr std::string_view unpack = "unpack it, and give the file inside";

constexpr std::array<Signature, 20> signatures{{
    {0, "\x1f\x8b"sv, {"a gzip archive", "unpack it with gunzip"}},
    {0, "version https://git-lfs"sv, {"a pointer of Git LFS, not the file itself", "fetch the file with git lfs pull"}},
    {0, "PK\x03\x04"sv, {"a ZIP archive", unpack}},
    {0, "\x28\xb5\x2f\xfd"sv, {"a Zstandard archive", "unpack it with unzstd"}},
    {0, "BZh"sv, {"a bzip2 archive", "unpack it with bunzip2"}},
    {0, "\xfd\x37zXZ\0"sv, {"an xz archive", "unpack it with unxz"}},
    {0, "7z\xbc\xaf\x27\x1c"sv, {"a 7z archive", unpack}},
    {257, "ustar"sv, {"a tar archive", unpack}},
    {0, "\x89HDF\r\n"sv, {"an HDF5 file", convert}},
    {0, "CDF\x01"sv, {"a NetCDF file", convert}},
    {0, "CDF\x02"sv, {"a NetCDF file", convert}},
    {0, "Ogawa"sv, {"an Alembic file", convert}},
    {0, "PXR-USDC"sv, {"a USD file", "give the .vdb file that it names"}},
    {0, "#usda"sv, {"a USD file", "give the .vdb file that it names"}},
    {0, "\x76\x2f\x31\x01"sv, {"an OpenEXR picture", "give a scene or a .vdb file"}},
    {0, "\x89PNG"sv, {"a PNG picture", "give a scene or a .vdb file"}},
    {0, "\xff\xd8\xff"sv, {"a JPEG picture", "give a scene or a .vdb file"}},
    {0, "<!DOCTYPE"sv, {"a web page", "download the file itself"}},
    {0, "<!doctype"sv, {"a web page", "download the file itself"}},
    {0, "<html"sv, {"a web page", "download the file itself"}},
}};

}  // namespace

std::string fileStart(const std::filesystem::path& path) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(path, ec)) return {};
    std::ifstream in(path, std::ios::binary);
    std::string start(fileStartBytes, '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(in.gcount()));
    return start;
}

bool isOpenVdb(std::string_view start) {
    return start.starts_with(" BDV\0\0\0\0"sv);
}

bool isNanoVdb(std::string_view start) {
    return start.starts_with("NanoVDB");
}

std::optional<ForeignFile> foreignFile(std::string_view start) {
    for (const Signature& signature : signatures)
        if (start.size() > signature.at && start.substr(signature.at).starts_with(signature.bytes))
            return signature.file;
    return std::nullopt;
}

}  // namespace lumulus
