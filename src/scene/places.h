#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <iosfwd>
#include <string>
#include <vector>

/// Places of clouds from a CSV file (`cloud.instances`, docs/fields.md).
namespace lumulus::scene {

/// Where one instance of a cloud stands.
struct Place {
    glm::dvec3 position{0.0};  ///< metres
    double yaw = 0.0;          ///< degrees, clockwise seen from above
    double scale = 1.0;        ///< factor of all lengths
    double extinction = 1.0;   ///< factor

    /// From the cloud to the world: scaled and rotated about the origin, then moved.
    glm::dmat4 transform() const;

    bool operator==(const Place&) const = default;
};

/// The rows of a file.
struct Places {
    std::vector<Place> rows;  ///< the first ones: `most` at most
    std::size_t count = 0;    ///< of all rows of the file
};

/// Reads `x,y,z,yaw,scale,extinction`, where all after `z` may be left out and empty lines do not count. Only `most`
/// rows are kept, so that a file of any length takes no memory. Errors: InputError with file, line and column for what
/// is no number, not finite, or out of range (coordinates within 1e7 m, scale above 0), and for a file without a row.
Places readPlaces(std::istream& file, const std::string& name, std::size_t most);
Places readPlaces(const std::filesystem::path& file, std::size_t most);

}  // namespace lumulus::scene
