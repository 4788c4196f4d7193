#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace lumulus::scene {

/// A phase function as a file has it.
struct PhaseTable {
    std::vector<double> angles;  ///< degrees, rising from 0 to 180
    std::vector<double> values;  ///< per solid angle, in any unit; 0 or more, and not all 0
};

/// What is wrong with a file of a phase function, in parts for a message.
struct PhaseTableError : std::runtime_error {
    PhaseTableError(std::string thePlace, std::string theFault, std::string theMend)
        : std::runtime_error(thePlace + ": " + theFault),
          place(std::move(thePlace)),
          fault(std::move(theFault)),
          mend(std::move(theMend)) {}

    std::string place;  ///< file, and the line where there is one
    std::string fault, mend;
};

/// Reads a text file of at most 1 MiB with an angle and a value in each line, separated by spaces or a comma; # begins
/// a comment. Errors: PhaseTableError if it cannot be read, has other text, NaN, infinite or negative values, angles
/// that do not rise, or if they do not go from 0 to 180 degrees.
PhaseTable readPhaseTable(const std::filesystem::path& file);

}  // namespace lumulus::scene
