#include "bench/peer.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"

namespace lumulus::bench {
namespace {

constexpr std::array columns{&Row::seconds, &Row::warmSeconds, &Row::amount, &Row::relMse,
                             &Row::rmse,    &Row::flip,        &Row::bias,   &Row::relativeBias};

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t end = text.find(at); end != std::string_view::npos; end = text.find(at)) {
        parts.push_back(text.substr(0, end));
        text.remove_prefix(end + 1);
    }
    parts.push_back(text);
    return parts;
}

class Line {
  public:
    Line(std::string_view text, std::string where) : fields_(split(text, ',')), where_(std::move(where)) {}

    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError(what, where_, "give the table that scripts/study/run cycles makes");
    }

    Row row() const {
        if (fields_.size() != 3 + 2 * columns.size()) refuse(fmt::format("{} values", fields_.size()));
        if (fields_[0] != nameOf(Method::cycles)) refuse(fmt::format("the method \"{}\"", fields_[0]));
        Row row;
        row.method = Method::cycles;
        row.budget = number(1);
        row.seeds = static_cast<std::size_t>(number(2));
        for (std::size_t i = 0; i < columns.size(); ++i) row.*columns[i] = {number(3 + 2 * i), number(4 + 2 * i)};
        for (const Spread* positive : {&row.seconds, &row.warmSeconds, &row.amount})
            if (!(positive->mean > 0.0)) refuse("a time or a number of samples that is not above 0");
        return row;
    }

  private:
    std::vector<std::string_view> fields_;
    std::string where_;

    double number(std::size_t field) const {
        const std::string_view text = fields_[field];
        double value = 0.0;
        const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
        if (end.ec != std::errc() || end.ptr != text.data() + text.size() || !(std::abs(value) < 1e15))
            refuse(fmt::format("\"{}\" is no number", text));
        return value;
    }
};

}  // namespace

std::vector<Row> parsePeer(std::string_view text, const std::string& source) {
    std::vector<Row> rows;
    const std::vector<std::string_view> lines = split(text, '\n');
    const std::string names = csv({});
    if (std::string(lines.front()) + "\n" != names)
        throw InputError("the columns are not those of error.csv", source + ":1",
                         "begin with " + names.substr(0, names.size() - 1));
    for (std::size_t i = 1; i < lines.size(); ++i)
        if (!lines[i].empty()) rows.push_back(Line(lines[i], fmt::format("{}:{}", source, i + 1)).row());
    return rows;
}

std::vector<Row> readPeer(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError("cannot read the file", path.string(), "give a table (.csv)");
    return parsePeer(std::string(std::istreambuf_iterator<char>(file), {}), path.string());
}

}  // namespace lumulus::bench
