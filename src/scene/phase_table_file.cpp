#include "scene/phase_table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

namespace lumulus::scene {
namespace {

constexpr std::size_t maximumBytes = std::size_t{1} << 20;

std::string textOf(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& fault) -> PhaseTableError {
        return {path.string(), fault, "give a text file of angles and values, its path relative to the scene file"};
    };
    std::error_code ec;
    if (std::filesystem::is_directory(path, ec)) throw fail("is a folder");
    if (!std::filesystem::is_regular_file(path, ec)) throw fail("does not exist");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw fail("cannot be read: " + std::generic_category().message(errno));
    std::string text(maximumBytes + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (file.bad()) throw fail("cannot be read");
    if (text.size() > maximumBytes) throw fail("is larger than 1 MiB");
    return text;
}

bool separates(char c) {
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

/// Takes the next number off a line; nothing at its end and for what is none.
std::optional<double> takeNumber(std::string_view& line) {
    while (!line.empty() && separates(line.front())) line.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc{}) return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (!line.empty() && !separates(line.front())) return std::nullopt;
    return value;
}

/// Adds a line's angle and value. `fail` throws with the line's number.
template <class Fail>
void addLine(std::string_view line, PhaseTable& table, const Fail& fail) {
    line = line.substr(0, line.find('#'));
    if (std::ranges::all_of(line, separates)) return;
    const auto angle = takeNumber(line), value = takeNumber(line);
    if (!angle || !value || !std::ranges::all_of(line, separates))
        fail("is not an angle and a value", "write two numbers, as: 0.5 1200");
    if (!std::isfinite(*angle) || !std::isfinite(*value)) fail("has a number that is not finite", "mend that line");
    constexpr double largest = 1e30;
    if (*value > largest) fail("has a value above 1e30", "give the values in a larger unit");
    if (*value < 0.0) fail("has a negative value", "mend that line");
    if (!table.angles.empty() && *angle <= table.angles.back())
        fail("has an angle that is not above the one before", "sort the lines by their angles, in degrees");
    table.angles.push_back(*angle);
    table.values.push_back(*value);
}

}  // namespace

PhaseTable readPhaseTable(const std::filesystem::path& file) {
    const std::string text = textOf(file);
    PhaseTable table;
    std::size_t number = 0;
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t end = rest.find('\n');
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        ++number;
        addLine(line, table, [&](const char* fault, const char* mend) {
            throw PhaseTableError(fmt::format("{}:{}", file.string(), number), fault, mend);
        });
    }
    const auto fail = [&](const char* fault, const char* mend) { throw PhaseTableError(file.string(), fault, mend); };
    if (table.angles.size() < 2 || table.angles.front() != 0.0 || table.angles.back() != 180.0)
        fail("has angles that do not go from 0 to 180", "give the whole sphere, in degrees");
    if (std::ranges::none_of(table.values, [](double v) { return v > 0.0; }))
        fail("has no value above 0", "give the phase function in any unit");
    return table;
}

}  // namespace lumulus::scene
