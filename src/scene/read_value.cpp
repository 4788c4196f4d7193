#include "scene/read_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "scene/utc.h"

namespace lumulus::scene {
namespace {

/// A key and its place, for messages about its value.
struct Reader {
    const Key& key;
    const std::string& where;

    std::string_view shortName() const { return key.name.substr(key.name.rfind('.') + 1); }
    std::string mend() const {
        if (key.fallback.starts_with('(')) return "give such a value, or leave it out " + std::string(key.fallback);
        return fmt::format("give such a value, or leave it out for {}", key.fallback);
    }
    [[noreturn]] void wrongType(const toml::node& node) const {
        throw InputError(fmt::format("{} must be {}, got {}", shortName(), typeText(key), nodeTypeText(node)), where,
                         mend());
    }
    [[noreturn]] void outOfRange(const std::string& got) const {
        const bool open = key.range.openLow || key.range.openHigh;
        throw InputError(
            fmt::format("{} must {} {}, got {}", shortName(), open ? "be" : "lie in", key.range.text(), got), where,
            mend());
    }

    double number(const toml::node& node) const {
        if (!node.is_number()) wrongType(node);
        const double x =
            node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
        if (!std::isfinite(x) || !key.range.contains(x)) outOfRange(fmt::format("{}", x));
        return x;
    }

    /// Reads an integer. 1e6 counts as an integer too, since people write numbers of photons so.
    std::int64_t integer(const toml::node& node) const {
        if (const auto* exact = node.as_integer()) {
            if (!key.range.contains(static_cast<double>(exact->get()))) outOfRange(fmt::format("{}", exact->get()));
            return exact->get();
        }
        const double x = number(node);
        if (x != std::floor(x)) {
            throw InputError(fmt::format("{} must be a whole number, got {}", shortName(), x), where, mend());
        }
        return static_cast<std::int64_t>(x);
    }

    bool boolean(const toml::node& node) const {
        const auto* value = node.as_boolean();
        if (value == nullptr) wrongType(node);
        return value->get();
    }

    glm::dvec3 vector(const toml::node& node) const {
        const auto* array = node.as_array();
        if (array == nullptr || array->size() != 3) wrongType(node);
        return {number(*array->get(0)), number(*array->get(1)), number(*array->get(2))};
    }

    /// One velocity, or rows of a height and the velocity there.
    Wind wind(const toml::node& node) const {
        const auto* rows = node.as_array();
        if (rows == nullptr || rows->empty() || !rows->get(0)->is_array()) return vector(node);
        if (rows->size() > Wind::mostLevels)
            throw InputError(fmt::format("{} has {} rows, more than {}", shortName(), rows->size(), Wind::mostLevels),
                             where, "leave rows out: it is linear between them");
        Wind wind;
        wind.levels.clear();
        for (const toml::node& each : *rows) {
            const auto* row = each.as_array();
            const std::size_t place = wind.levels.size() + 1;
            if (row == nullptr || row->size() != 4)
                throw InputError(fmt::format("{} must be {}, got {} as row {}", shortName(), typeText(key),
                                             nodeTypeText(each), place),
                                 where, mend());
            const double height = number(*row->get(0));
            if (!wind.levels.empty() && height <= wind.levels.back().height)
                throw InputError(fmt::format("the heights of {} must rise, got {} behind {} in row {}", shortName(),
                                             height, wind.levels.back().height, place),
                                 where, "put the rows in the order of their heights");
            wind.levels.push_back({height, {number(*row->get(1)), number(*row->get(2)), number(*row->get(3))}});
        }
        return wind;
    }

    glm::dvec3 pair(const toml::node& node) const {
        const auto* array = node.as_array();
        if (array == nullptr || array->size() != 2) wrongType(node);
        const auto first = integer(*array->get(0)), last = integer(*array->get(1));
        if (last < first)
            throw InputError(fmt::format("{} must rise, got [{}, {}]", shortName(), first, last), where, mend());
        return {static_cast<double>(first), static_cast<double>(last), 0.0};
    }

    glm::dmat4 matrix(const toml::node& node) const {
        const auto* rows = node.as_array();
        if (rows == nullptr || (rows->size() != 3 && rows->size() != 4)) wrongType(node);
        glm::dmat4 m(1.0);
        for (int row = 0; row < static_cast<int>(rows->size()); ++row) {
            const auto* columns = rows->get(static_cast<std::size_t>(row))->as_array();
            if (columns == nullptr || columns->size() != 4) wrongType(node);
            for (int column = 0; column < 4; ++column) {
                m[column][row] = number(*columns->get(static_cast<std::size_t>(column)));
            }
        }
        if (glm::transpose(m)[3] != glm::dvec4(0.0, 0.0, 0.0, 1.0)) {
            throw InputError("the last row of transform must be [0, 0, 0, 1]", where, "leave the fourth row out");
        }
        checkInvertible(glm::dmat3(m));
        return m;
    }

    void checkInvertible(const glm::dmat3& linear) const {
        // relative to the product of the columns' lengths, so that the scale does not matter
        const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
        if (!(std::abs(glm::determinant(linear)) > 1e-9 * volume)) {
            throw InputError("transform must be invertible", where, "its three columns must span the space");
        }
    }

    std::string text(const toml::node& node) const {
        const auto* string = node.as_string();
        if (string == nullptr) wrongType(node);
        if (key.type == Type::path && (string->get().empty() || string->get().find('\0') != std::string::npos)) {
            throw InputError(fmt::format("{} must be a file name, got an empty or broken one", shortName()), where,
                             mend());
        }
        return string->get();
    }

    /// A string or a date and time of TOML, both of universal time. Returns it as a string.
    std::string time(const toml::node& node) const {
        std::string text;
        if (const auto* given = node.as_date_time()) {
            const toml::date_time t = given->get();
            const bool universal = t.offset && t.offset->minutes == 0;
            text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", t.date.year, t.date.month, t.date.day,
                               t.time.hour, t.time.minute, t.time.second);
            if (t.time.nanosecond != 0) text += fmt::format(".{:09}", t.time.nanosecond);
            if (universal) text += "Z";
        } else {
            const auto* string = node.as_string();
            if (string == nullptr) wrongType(node);
            text = string->get();
        }
        if (!parseUtc(text))
            throw InputError(
                fmt::format("{} must be {}, got \"{}\"", shortName(), typeText(key), shortened(oneLine(text), 40)),
                where, mend());
        return text;
    }

    std::size_t choice(const toml::node& node) const {
        const auto* string = node.as_string();
        if (string == nullptr) wrongType(node);
        const auto it = std::ranges::find(key.choices, std::string_view(string->get()));
        if (it == key.choices.end()) {
            throw InputError(fmt::format("{} must be {}, got \"{}\"", shortName(), typeText(key), string->get()), where,
                             mend());
        }
        return static_cast<std::size_t>(it - key.choices.begin());
    }
};

}  // namespace

std::string nodeTypeText(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return fmt::format("an array of {}", node.as_array()->size());
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

Value readValue(const toml::node& node, const Key& key, const std::string& where) {
    const Reader reader{key, where};
    Value value;
    switch (key.type) {
        case Type::number:
            value.number = reader.number(node);
            break;
        case Type::integer:
            value.integer = reader.integer(node);
            break;
        case Type::boolean:
            value.boolean = reader.boolean(node);
            break;
        case Type::vector:
            value.vector = reader.vector(node);
            break;
        case Type::wind:
            value.wind = reader.wind(node);
            break;
        case Type::pair:
            value.vector = reader.pair(node);
            break;
        case Type::rgb:
            value.vector = node.is_array() ? reader.vector(node) : glm::dvec3(reader.number(node));
            break;
        case Type::matrix:
            value.matrix = reader.matrix(node);
            break;
        case Type::text:
        case Type::path:
            value.text = reader.text(node);
            break;
        case Type::time:
            value.text = reader.time(node);
            break;
        case Type::choice:
            value.choice = reader.choice(node);
            value.text = key.choices[value.choice];
            break;
    }
    return value;
}

}  // namespace lumulus::scene
