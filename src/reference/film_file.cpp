#include "reference/film_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <type_traits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "reference/fingerprint.h"

namespace lumulus::reference {
namespace {

namespace fs = std::filesystem;

/// The header before the sums. Doubles and integers are in the machine's own format: the file belongs to this machine.
struct Header {
    char magic[16] = "lumulus sums 2\n";
    std::uint64_t fingerprint = 0;
    std::int64_t width = 0, height = 0;
    std::uint64_t samples = 0, lost = 0;
    double seconds = 0.0;
    std::uint64_t checksum = 0;  ///< of the sums
};

static_assert(std::is_trivially_copyable_v<PixelSums> && std::is_trivially_copyable_v<Header>);

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError("the exact sums of the picture are missing", path.string(),
                         "keep them beside the picture, or leave out --resume");
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

fs::path sumsBeside(const fs::path& picture) {
    fs::path path = picture;
    path += ".sums";
    return path;
}

void writeFilm(const fs::path& path, const Film& film, std::uint64_t fingerprint) {
    const std::span<const std::byte> sums = std::as_bytes(std::span(film.pixels));
    Header header;
    header.fingerprint = fingerprint;
    header.width = film.width;
    header.height = film.height;
    header.samples = film.samples;
    header.lost = film.lost;
    header.seconds = film.seconds;
    header.checksum = Fingerprint().add(sums).value();
    std::vector<std::byte> bytes(sizeof(Header) + sums.size());
    std::memcpy(bytes.data(), &header, sizeof(Header));
    std::memcpy(bytes.data() + sizeof(Header), sums.data(), sums.size());
    writeFile(path, bytes);
}

Film readFilm(const fs::path& path, std::uint64_t fingerprint) {
    const std::string content = contentOf(path);
    const InputError damaged("the exact sums are damaged", path.string(),
                             "remove them and the picture, and render again");
    Header header;
    const Header expected;
    if (content.size() < sizeof(Header)) throw damaged;
    std::memcpy(&header, content.data(), sizeof(Header));
    const std::size_t bytes = content.size() - sizeof(Header);
    if (std::memcmp(header.magic, expected.magic, sizeof(header.magic)) != 0) throw damaged;
    if (header.width <= 0 || header.height <= 0 || header.samples == 0 || bytes % sizeof(PixelSums) != 0 ||
        header.width > (1 << 20) || header.height > (1 << 20) ||
        static_cast<std::size_t>(header.width * header.height) != bytes / sizeof(PixelSums)) {
        throw damaged;
    }
    Film film;
    film.width = static_cast<int>(header.width);
    film.height = static_cast<int>(header.height);
    film.samples = header.samples;
    film.lost = header.lost;
    film.seconds = header.seconds;
    film.pixels.resize(bytes / sizeof(PixelSums));
    std::memcpy(static_cast<void*>(film.pixels.data()), content.data() + sizeof(Header), bytes);
    if (Fingerprint().add(std::as_bytes(std::span(film.pixels))).value() != header.checksum) throw damaged;
    if (header.fingerprint != fingerprint) {
        throw InputError("the picture was made from another scene, seed or majorant", path.string(),
                         "give another -o, or leave out --resume");
    }
    return film;
}

}  // namespace lumulus::reference
