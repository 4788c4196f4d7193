#include "support/rico.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace lumulus::test {
namespace {

/// The next line's numbers, which commas separate.
std::vector<double> readNumbers(std::istream& in) {
    std::string line;
    if (!std::getline(in, line)) return {};
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> numbers;
    for (double number = 0.0; words >> number;) numbers.push_back(number);
    return numbers;
}

}  // namespace

std::optional<std::filesystem::path> findTestData(const std::string& name) {
    const char* folder = std::getenv("LUMULUS_TEST_DATA");
    const std::filesystem::path base = folder != nullptr ? std::filesystem::path(folder)
                                                         : std::filesystem::path(LUMULUS_SOURCE_DIR) / "../shared/data";
    if (!std::filesystem::exists(base / name)) return std::nullopt;
    return base / name;
}

vdb::Volume readRico(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::string title;
    std::getline(in, title);
    const std::vector<double> counts = readNumbers(in);
    const std::vector<double> spacing = readNumbers(in);   // km, along x and y
    const std::vector<double> altitude = readNumbers(in);  // km
    if (counts.size() != 3 || spacing.size() != 2 || altitude.size() < 2) {
        throw Error("the head of the field is damaged", path.string(), "copy the file again");
    }
    std::getline(in, title);
    const glm::ivec3 cells(glm::dvec3(counts[0], counts[1], counts[2]));
    vdb::Volume volume;
    volume.name = "rico";
    volume.size = {cells.x, cells.z, cells.y};
    volume.density.assign(volume.index(0, 0, volume.size.z), 0.0F);
    for (std::vector<double> row = readNumbers(in); row.size() == 5; row = readNumbers(in)) {
        const glm::ivec3 cell(glm::dvec3(row[0], row[1], row[2]));
        if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, cells))) {
            throw Error("a cell lies outside of the field", path.string(), "copy the file again");
        }
        volume.density[volume.index(cell.x, cell.z, cells.y - 1 - cell.y)] = static_cast<float>(1.5 * row[3] / row[4]);
    }
    volume.maximum = *std::max_element(volume.density.begin(), volume.density.end());
    const double kilometre = 1000.0;
    const glm::dvec3 voxel(spacing[0] * kilometre, (altitude[1] - altitude[0]) * kilometre, spacing[1] * kilometre);
    volume.toWorld.linear = glm::dmat3(voxel.x, 0, 0, 0, voxel.y, 0, 0, 0, voxel.z);
    // an altitude is that of the middle of its cells
    volume.toWorld.translation = {-0.5 * volume.size.x * voxel.x, altitude[0] * kilometre - 0.5 * voxel.y,
                                  -0.5 * volume.size.z * voxel.z};
    return volume;
}

}  // namespace lumulus::test
