#include "scene/places.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <istream>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/text.h"

namespace lumulus::scene {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr std::size_t longestLine = 4096;

/// A column of the file: its values lie within the ends, or strictly above the lower one.
struct Column {
    std::string_view name;
    double low, high;
    bool openLow;
    double fallback;
};

constexpr std::array<Column, 6> columns{{
    {"x", -1e7, 1e7, false, 0.0},
    {"y", -1e7, 1e7, false, 0.0},
    {"z", -1e7, 1e7, false, 0.0},
    {"yaw", -1e6, 1e6, false, 0.0},
    {"scale", 0.0, 1e6, true, 1.0},
    {"extinction", 0.0, 1e6, false, 1.0},
}};
constexpr std::size_t needed = 3;

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view space = " \t\r";
    const std::size_t first = text.find_first_not_of(space);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::vector<std::string_view> cellsOf(std::string_view line) {
    std::vector<std::string_view> cells;
    while (true) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos || cells.size() > columns.size()) return cells;
        line.remove_prefix(comma + 1);
    }
}

std::string shown(std::string_view text) {
    return shortened(oneLine(std::string(text)), 40);
}

/// Reads the file line by line.
class Reader {
  public:
    Reader(std::istream& file, const std::string& name) : file_(file), name_(name) {}

    Places read(std::size_t most) {
        readHeader();
        Places places;
        while (next()) {
            const Place place = readRow();
            if (++places.count <= most) places.rows.push_back(place);
        }
        if (places.count == 0)
            throw InputError("the file has no places", name_, "give a row for each instance, or leave instances out");
        return places;
    }

  private:
    [[noreturn]] void fail(const std::string& what, const std::string& mend, std::string_view column = {}) const {
        const std::string place = column.empty() ? "" : fmt::format(", {}", column);
        throw InputError(what, fmt::format("{}:{}{}", name_, number_, place), mend);
    }

    /// Goes to the next line with something in it.
    bool next() {
        while (std::getline(file_, line_)) {
            ++number_;
            if (line_.size() > longestLine) fail("the line is longer than 4096 bytes", "give a file of places (CSV)");
            if (!trimmed(line_).empty()) return true;
        }
        if (file_.bad()) throw InputError("cannot read the file", name_, "check the disk");
        return false;
    }

    void readHeader() {
        constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
        constexpr std::string_view mend =
            "begin it with the line x,y,z,yaw,scale,extinction; all after z may be left out";
        if (!next()) throw InputError("the file is empty", name_, std::string(mend));
        std::string_view line = line_;
        if (line.starts_with(byteOrderMark)) line.remove_prefix(byteOrderMark.size());
        const std::vector<std::string_view> names = cellsOf(line);
        for (std::size_t i = 0; i < names.size(); ++i)
            if (i >= columns.size() || names[i] != columns[i].name)
                fail(fmt::format("column {} is called \"{}\"", i + 1, shown(names[i])), std::string(mend));
        if (names.size() < needed) fail("the file has no column z", std::string(mend));
        width_ = names.size();
    }

    double readCell(std::string_view cell, const Column& column) const {
        double value = 0.0;
        if (cell.starts_with('+')) cell.remove_prefix(1);
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (cell.empty() || end != cell.data() + cell.size() || error == std::errc::invalid_argument)
            fail(fmt::format("\"{}\" is no number", shown(cell)), "give a number, as 12.5", column.name);
        const bool inside =
            error == std::errc() && (column.openLow ? value > column.low : value >= column.low) && value <= column.high;
        if (!inside)
            fail(fmt::format("{} is {}", column.name, shown(cell)),
                 column.openLow ? fmt::format("give a number above {:g}, at most {:g}", column.low, column.high)
                                : fmt::format("give a number from {:g} to {:g}", column.low, column.high),
                 column.name);
        return value;
    }

    Place readRow() const {
        const std::vector<std::string_view> cells = cellsOf(line_);
        if (cells.size() != width_)
            fail(fmt::format("the row has {} columns, the first line {}",
                             cells.size() > columns.size() ? "more than 6" : std::to_string(cells.size()), width_),
                 "give every row the columns of the first line");
        std::array<double, columns.size()> values{};
        for (std::size_t i = 0; i < columns.size(); ++i)
            values[i] = i < width_ ? readCell(cells[i], columns[i]) : columns[i].fallback;
        return {{values[0], values[1], values[2]}, values[3], values[4], values[5]};
    }

    std::istream& file_;
    const std::string& name_;
    std::string line_;
    std::size_t number_ = 0;  ///< of the line, from 1
    std::size_t width_ = 0;   ///< columns of the file
};

}  // namespace

glm::dmat4 Place::transform() const {
    const double angle = yaw * pi / 180.0;
    const double c = scale * std::cos(angle), s = scale * std::sin(angle);
    return {{c, 0.0, s, 0.0}, {0.0, scale, 0.0, 0.0}, {-s, 0.0, c, 0.0}, glm::dvec4(position, 1.0)};
}

Places readPlaces(std::istream& file, const std::string& name, std::size_t most) {
    return Reader(file, name).read(most);
}

Places readPlaces(const std::filesystem::path& file, std::size_t most) {
    constexpr std::uintmax_t mostBytes = std::uintmax_t{256} << 20;
    std::error_code ec;
    // a pipe would be waited for
    if (std::filesystem::exists(file, ec) && !std::filesystem::is_regular_file(file, ec))
        throw InputError("this is no file", file.string(), "give a CSV file of places");
    if (const std::uintmax_t bytes = std::filesystem::file_size(file, ec); !ec && bytes > mostBytes)
        throw InputError(fmt::format("the file has {} MiB, more than {}", bytes >> 20, mostBytes >> 20), file.string(),
                         "leave rows out");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InputError("cannot read the file: " + std::generic_category().message(errno), file.string(),
                         "give a file that exists and may be read");
    return readPlaces(stream, file.string(), most);
}

}  // namespace lumulus::scene
