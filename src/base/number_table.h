#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumulus {

/// Rows of numbers from a CSV file. A first row with the names of the columns may stand before them; empty lines are
/// skipped. All numbers are finite and at most 1e9 in magnitude.
struct NumberTable {
    std::size_t columns = 0;
    std::vector<double> numbers;  ///< row by row

    std::size_t rows() const { return columns > 0 ? numbers.size() / columns : 0; }
    const double* row(std::size_t number) const { return &numbers[number * columns]; }
};

/// Reads a table with exactly these columns. Errors: InputError with `source`, line and what is wrong, also where there
/// are more than `mostRows` rows.
NumberTable parseNumberTable(std::string_view text, std::span<const std::string_view> columns,
                             const std::string& source, std::size_t mostRows);

/// Reads the table of a file, of standard input for "-". Errors: as above; InputError where it cannot be read.
NumberTable readNumberTable(const std::filesystem::path& path, std::span<const std::string_view> columns,
                            std::size_t mostRows);

}  // namespace lumulus
