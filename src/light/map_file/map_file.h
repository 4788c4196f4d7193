#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "light/photon/traced_sums.h"

/// Photon maps as files, so that parts of one may be traced on several machines, at several times, and added up exactly
/// (docs/maps.md has the format).
namespace lumulus::map_file {

struct MapFile {
    std::string fingerprint{};  ///< of all that the light depends on, 64 hexadecimal digits
    photon::TracedSums sums{};
};

/// Writes a whole file or none. Errors: those of lumulus::writeFile.
void writeMap(const std::filesystem::path& path, const MapFile& map);

/// Errors: InputError for what is no map, of another version, cut short or damaged.
MapFile readMap(const std::filesystem::path& path);

/// Adds `more`, which was read from `path`. Errors: InputError where it is of other light, or has a generation that
/// `sum` has too.
void addMap(MapFile& sum, const MapFile& more, const std::filesystem::path& path);

/// Reads and adds up maps, at least one. Errors: as above.
MapFile readMaps(std::span<const std::filesystem::path> paths);

/// "0-9, 20": generations in words.
std::string inWords(std::span<const photon::GenerationRange> generations);

}  // namespace lumulus::map_file
