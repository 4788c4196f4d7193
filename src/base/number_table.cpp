#include "base/number_table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>

#include "base/error.h"
#include "base/text.h"

namespace lumulus {

namespace {

constexpr double largest = 1e9;
constexpr std::size_t longestShown = 60;  // bytes of a field or a line in a message

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes the part before the next `mark` off the text.
std::string_view taken(std::string_view& text, char mark) {
    const std::size_t end = text.find(mark);
    const std::string_view part = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    return part;
}

std::optional<double> numberOf(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || end.ptr != text.data() + text.size() || end.ec == std::errc::invalid_argument) return {};
    return end.ec == std::errc::result_out_of_range ? HUGE_VAL : value;
}

std::string shown(std::string_view text) {
    return fmt::format("\"{}\"", shortened(oneLine(text), longestShown));
}

class Reader {
  public:
    Reader(std::span<const std::string_view> columns, const std::string& source, std::size_t mostRows)
        : columns_(columns), source_(source), mostRows_(mostRows) {
        table_.columns = columns.size();
    }

    NumberTable read(std::string_view text) {
        if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // some spreadsheets mark UTF-8 so
        while (!text.empty()) {
            ++line_;
            const std::string_view line = trimmed(taken(text, '\n'));
            if (line.empty()) continue;
            const bool names = !begun_ && !numberOf(trimmed(line.substr(0, line.find(','))));
            begun_ = true;
            names ? compareNames(line) : addRow(line);
        }
        return std::move(table_);
    }

  private:
    std::string names() const {
        std::string all;
        for (const std::string_view name : columns_) all += (all.empty() ? "" : ",") + std::string(name);
        return all;
    }

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(what, source_ + ":" + std::to_string(line_), "each row has the numbers " + names());
    }

    void compareNames(std::string_view line) const {
        std::string_view rest = line;
        for (const std::string_view name : columns_)
            if (trimmed(taken(rest, ',')) != name) refuse(shown(line) + " is neither numbers nor the names of columns");
        if (!rest.empty()) refuse("more than " + std::to_string(columns_.size()) + " columns");
    }

    void addRow(std::string_view line) {
        if (table_.rows() == mostRows_)
            throw InputError("more than " + std::to_string(mostRows_) + " rows", source_, "give several files");
        std::size_t found = 0;
        for (bool more = true; more; ++found) {
            more = line.find(',') != std::string_view::npos;
            const std::string_view field = trimmed(taken(line, ','));
            if (found == columns_.size()) refuse("more than " + std::to_string(found) + " numbers");
            const std::optional<double> value = numberOf(field);
            if (!value) refuse(fmt::format("{} = {} is no number", columns_[found], shown(field)));
            if (!(std::abs(*value) <= largest))
                refuse(fmt::format("{} = {} is not within ±1e9", columns_[found], shown(field)));
            table_.numbers.push_back(*value);
        }
        if (found < columns_.size())
            refuse(std::to_string(found) + " of " + std::to_string(columns_.size()) + " numbers");
    }

    std::span<const std::string_view> columns_;
    const std::string& source_;
    std::size_t mostRows_;
    std::size_t line_ = 0;
    bool begun_ = false;
    NumberTable table_;
};

}  // namespace

NumberTable parseNumberTable(std::string_view text, std::span<const std::string_view> columns,
                             const std::string& source, std::size_t mostRows) {
    return Reader(columns, source, mostRows).read(text);
}

NumberTable readNumberTable(const std::filesystem::path& path, std::span<const std::string_view> columns,
                            std::size_t mostRows) {
    if (path == "-")
        return parseNumberTable(std::string(std::istreambuf_iterator<char>(std::cin), {}), columns, "standard input",
                                mostRows);
    std::ifstream file(path, std::ios::binary);
    const bool readable = file && !std::filesystem::is_directory(path);
    if (!readable) throw InputError("cannot read the file", path.string(), "give a table (.csv)");
    return parseNumberTable(std::string(std::istreambuf_iterator<char>(file), {}), columns, path.string(), mostRows);
}

}  // namespace lumulus
