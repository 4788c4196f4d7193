#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vdb/volume.h"

/// Optional data of the tests, which is not part of the project.
namespace lumulus::test {

/// A file of the folder that the environment variable LUMULUS_TEST_DATA names (else ../shared/data beside the sources),
/// if it is there.
std::optional<std::filesystem::path> findTestData(const std::string& name);

/// The cumulus of the RICO large-eddy simulation (doi 10.1175/JAS-D-13-0306.1) from its text file
/// `rico122x106x39.txt`: cells of 20 m, 40 m high. The density is the extinction itself, β = 1.5·LWC/r_e [1/m] with LWC
/// in g/m³ and r_e in µm: a scene uses it with extinction = 1. The file counts cells from 0 and has z up; here +Y is
/// up, its y points to −z, altitudes are kept and the middle of the field is above the origin. Throws Error for a
/// damaged file.
vdb::Volume readRico(const std::filesystem::path& path);

}  // namespace lumulus::test
