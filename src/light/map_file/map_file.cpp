#include "light/map_file/map_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "service/values/sha256.h"

namespace lumulus::map_file {
namespace {

using photon::GenerationRange;
using photon::TracedSums;

static_assert(std::endian::native == std::endian::little, "the file has little-endian numbers");

constexpr std::string_view magic = "lumulus map 1\n";  // then zeros up to 16 bytes
constexpr std::string_view anyVersion = "lumulus map ";
constexpr std::size_t magicBytes = 16, digits = 64;
/// Counts that a map can have at most: a buffer of 16 GiB. More is damage.
constexpr std::uint64_t mostCounts = 1ULL << 31U;
constexpr std::uint64_t mostRanges = 1ULL << 20U;
/// Bytes that zlib can make of one: what claims more is damage, and would take memory before that shows.
constexpr std::uint64_t mostGrowth = 1032;
constexpr int largestExponent = 1000;  // of a watt, to either side
constexpr int compression = 1;         // most bytes are the equal high ones of small numbers
/// Sums are clamped here, as accumulate.comp clamps them.
constexpr std::int64_t largest = (std::int64_t{1} << 61U) - 1;

class Writer {
  public:
    template <class T>
    Writer& add(const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        return bytes(std::as_bytes(std::span(&value, 1)));
    }
    Writer& bytes(std::span<const std::byte> more) {
        content.insert(content.end(), more.begin(), more.end());
        return *this;
    }
    std::vector<std::byte> content;
};

class Reader {
  public:
    Reader(std::span<const std::byte> bytes, const std::filesystem::path& path) : left_(bytes), path_(path) {}

    template <class T>
    T get() {
        static_assert(std::is_arithmetic_v<T>);
        T value;
        std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::span<const std::byte> bytes(std::size_t count) {
        if (count > left_.size()) fail("is cut short");
        const auto taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }
    std::size_t left() const { return left_.size(); }
    [[noreturn]] void fail(const char* what) const {
        throw InputError(fmt::format("the photon map {}", what), path_.string(), "trace it again");
    }

  private:
    std::span<const std::byte> left_;
    const std::filesystem::path& path_;
};

/// The lowest bytes of all counts, then the next ones, and so on.
std::vector<Bytef> byPlaces(std::span<const std::int64_t> counts) {
    std::vector<Bytef> bytes(counts.size() * sizeof(std::int64_t));
    for (std::size_t place = 0; place < sizeof(std::int64_t); ++place) {
        stopIfInterrupted();
        Bytef* const to = bytes.data() + place * counts.size();
        for (std::size_t i = 0; i < counts.size(); ++i)
            to[i] = static_cast<Bytef>(static_cast<std::uint64_t>(counts[i]) >> (8 * place));
    }
    return bytes;
}

std::vector<std::int64_t> fromPlaces(std::span<const Bytef> bytes) {
    std::vector<std::int64_t> counts(bytes.size() / sizeof(std::int64_t));
    for (std::size_t i = 0; i < counts.size(); ++i) {
        std::uint64_t value = 0;
        for (std::size_t place = 0; place < sizeof(std::int64_t); ++place)
            value |= static_cast<std::uint64_t>(bytes[place * counts.size() + i]) << (8 * place);
        counts[i] = static_cast<std::int64_t>(value);
    }
    return counts;
}

std::vector<Bytef> packed(std::span<const std::int64_t> counts) {
    const std::vector<Bytef> bytes = byPlaces(counts);
    uLongf size = compressBound(bytes.size());
    std::vector<Bytef> result(size);
    if (compress2(result.data(), &size, bytes.data(), bytes.size(), compression) != Z_OK)
        throw Error("the photon map cannot be compressed", "zlib", "free memory");
    result.resize(size);
    return result;
}

constexpr auto counterMembers = std::to_array(
    {&photon::Counters::emitted, &photon::Counters::events, &photon::Counters::nulls, &photon::Counters::absorbed,
     &photon::Counters::escaped, &photon::Counters::lost, &photon::Counters::records, &photon::Counters::saturated});
constexpr std::int32_t noUnit = std::numeric_limits<std::int32_t>::min();

std::vector<std::byte> contentOf(const std::filesystem::path& path) {
    std::error_code ec;
    const auto size = std::filesystem::file_size(path, ec);
    std::ifstream file(path, std::ios::binary);
    if (ec || !file || std::filesystem::is_directory(path))
        throw InputError("cannot read the photon map", path.string(), "give a file that --map-out has written");
    std::vector<std::byte> bytes(size);
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

/// Adds ranges, and joins those that touch. Returns a generation that is in both, or none.
std::optional<std::uint64_t> join(std::vector<GenerationRange>& sum, std::span<const GenerationRange> more) {
    sum.insert(sum.end(), more.begin(), more.end());
    std::ranges::sort(sum, {}, &GenerationRange::first);
    std::vector<GenerationRange> joined;
    for (const GenerationRange& range : sum) {
        if (!joined.empty() && joined.back().end() > range.first) return range.first;
        if (!joined.empty() && joined.back().end() == range.first)
            joined.back().count += range.count;
        else
            joined.push_back(range);
    }
    sum = std::move(joined);
    return std::nullopt;
}

void readHead(Reader& reader, MapFile& map) {
    const auto name = reader.bytes(std::min(magicBytes, reader.left()));
    const std::string_view text(reinterpret_cast<const char*>(name.data()), name.size());
    if (!text.starts_with(anyVersion)) reader.fail("is no photon map of lumulus");
    if (!text.starts_with(magic)) reader.fail("is of another version of the format");
    if (text.size() < magicBytes) reader.fail("is cut short");
    const auto fingerprint = reader.bytes(digits);
    map.fingerprint.assign(reinterpret_cast<const char*>(fingerprint.data()), digits);
    TracedSums& sums = map.sums;
    const auto unit = reader.get<std::int32_t>();
    if (unit != noUnit) sums.unitExponent = unit;
    if (unit != noUnit && std::abs(unit) > largestExponent) reader.fail("is damaged");
    sums.photonsEach = reader.get<std::uint64_t>();
    sums.flux = reader.get<double>();
    for (int axis = 0; axis < 3; ++axis) sums.sunDirection[axis] = reader.get<double>();
    if (!std::isfinite(sums.flux) || !std::isfinite(glm::length(sums.sunDirection))) reader.fail("is damaged");
    for (const auto member : counterMembers) sums.counters.*member = reader.get<std::uint64_t>();
    const auto ranges = reader.get<std::uint32_t>();
    if (ranges > mostRanges) reader.fail("is damaged");
    std::vector<GenerationRange> read;
    for (std::uint32_t i = 0; i < ranges; ++i) {
        const auto first = reader.get<std::uint64_t>(), count = reader.get<std::uint64_t>();
        if (count == 0 || first > (1ULL << 40U) || count > (1ULL << 40U)) reader.fail("is damaged");
        read.push_back({first, count});
    }
    if (join(sums.generations, read)) reader.fail("is damaged");
}

}  // namespace

void writeMap(const std::filesystem::path& path, const MapFile& map) {
    const TracedSums& sums = map.sums;
    Writer writer;
    std::array<char, magicBytes> name{};
    std::ranges::copy(magic, name.begin());
    writer.bytes(std::as_bytes(std::span(name)));
    writer.bytes(std::as_bytes(std::span(map.fingerprint)));
    writer.add(static_cast<std::int32_t>(sums.unitExponent.value_or(noUnit))).add(sums.photonsEach).add(sums.flux);
    for (int axis = 0; axis < 3; ++axis) writer.add(sums.sunDirection[axis]);
    for (const auto member : counterMembers) writer.add(sums.counters.*member);
    writer.add(static_cast<std::uint32_t>(sums.generations.size()));
    for (const GenerationRange& range : sums.generations) writer.add(range.first).add(range.count);
    const std::vector<Bytef> body = packed(sums.counts);
    writer.add(std::uint64_t{sums.counts.size()}).add(std::uint64_t{body.size()});
    writer.bytes(std::as_bytes(std::span(body)));
    const std::string checksum = service::sha256Hex(writer.content);
    writer.bytes(std::as_bytes(std::span(checksum)));
    writeFile(path, writer.content);
}

MapFile readMap(const std::filesystem::path& path) {
    const std::vector<std::byte> content = contentOf(path);
    Reader reader(content, path);
    MapFile map;
    readHead(reader, map);
    const auto counts = reader.get<std::uint64_t>(), bytes = reader.get<std::uint64_t>();
    const std::uint64_t unpacked = counts * sizeof(std::int64_t);
    if (counts > mostCounts || bytes > compressBound(unpacked) || unpacked / mostGrowth > bytes)
        reader.fail("is damaged");
    const auto body = reader.bytes(bytes);
    if (reader.left() < digits) reader.fail("is cut short");
    if (reader.left() > digits) reader.fail("has more bytes than it should");
    const auto checksum = reader.bytes(digits);
    const std::string expected = service::sha256Hex(std::span(content).first(content.size() - digits));
    if (std::memcmp(checksum.data(), expected.data(), digits) != 0) reader.fail("is damaged: its checksum is wrong");
    std::vector<Bytef> places(unpacked);
    uLongf size = places.size();
    if (uncompress(places.data(), &size, reinterpret_cast<const Bytef*>(body.data()), body.size()) != Z_OK ||
        size != places.size())
        reader.fail("is damaged");
    map.sums.counts = fromPlaces(places);
    return map;
}

void addMap(MapFile& sum, const MapFile& more, const std::filesystem::path& path) {
    TracedSums& to = sum.sums;
    const TracedSums& from = more.sums;
    if (sum.fingerprint != more.fingerprint || to.photonsEach != from.photonsEach ||
        to.counts.size() != from.counts.size() ||
        (to.unitExponent && from.unitExponent && to.unitExponent != from.unitExponent))
        throw InputError("the photon map is of another scene, light or seed than the one before it", path.string(),
                         "merge maps of one scene");
    if (const auto twice = join(to.generations, from.generations))
        throw InputError(fmt::format("generation {} is in a map before this one too", *twice), path.string(),
                         "give each part once");
    if (!to.unitExponent) {
        to.unitExponent = from.unitExponent;
        to.flux = from.flux;
        to.sunDirection = from.sunDirection;
    }
    for (const auto member : counterMembers) to.counters.*member += from.counters.*member;
    for (std::size_t i = 0; i < to.counts.size(); ++i)
        to.counts[i] = std::clamp(to.counts[i] + from.counts[i], -largest, largest);
}

MapFile readMaps(std::span<const std::filesystem::path> paths) {
    MapFile sum = readMap(paths.front());
    for (const std::filesystem::path& path : paths.subspan(1)) {
        stopIfInterrupted();
        addMap(sum, readMap(path), path);
    }
    return sum;
}

std::string inWords(std::span<const GenerationRange> generations) {
    std::string text;
    for (const GenerationRange& range : generations) {
        if (!text.empty()) text += ", ";
        text += range.count == 1 ? fmt::format("{}", range.first) : fmt::format("{}-{}", range.first, range.end() - 1);
    }
    return text;
}

}  // namespace lumulus::map_file
