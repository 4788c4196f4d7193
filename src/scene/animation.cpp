#include "scene/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/number_table.h"
#include "scene/check_file.h"
#include "scene/schema.h"

namespace lumulus::scene {

namespace {

constexpr std::size_t mostKeys = 100'000;
constexpr std::array<std::pair<std::string_view, Interpolation>, 4> names{{{"linear", Interpolation::linear},
                                                                           {"smooth", Interpolation::smooth},
                                                                           {"step", Interpolation::step},
                                                                           {"spline", Interpolation::spline}}};

std::string placeOf(const toml::node& node, const std::string& path, const std::string& source) {
    return fmt::format("{}:{}, animate.{}", source, node.source().begin.line, path);
}

/// A value taken apart: numbers, and what stands around them. Of what is no number there is the text alone.
struct Parts {
    std::string shape, text;
    std::vector<double> numbers;
    bool allNumbers = true;
};

std::string textOf(double number, bool whole) {
    return whole ? fmt::format("{:.0f}", number) : fmt::format("{}", number);
}

void take(const toml::node& node, bool whole, Parts& parts) {
    const auto add = [&parts](std::string_view more) {
        parts.shape += more;
        parts.text += more;
    };
    if (const toml::array* array = node.as_array()) {
        add("[");
        for (std::size_t i = 0; i < array->size(); ++i) {
            if (i > 0) add(", ");
            take(*array->get(i), whole, parts);
        }
        add("]");
    } else if (node.is_number()) {
        parts.numbers.push_back(node.value<double>().value_or(0.0));
        parts.shape += '#';
        parts.text += textOf(parts.numbers.back(), whole);
    } else {
        parts.allNumbers = false;
        std::ostringstream text;
        node.visit([&text](const auto& value) { text << value; });
        parts.text += text.str();
    }
}

/// "cloud.0.seed" → "cloud.seed", as the schema has it.
std::string withoutIndices(std::string_view path) {
    std::string name;
    std::size_t start = 0;
    while (start <= path.size()) {
        const std::size_t end = std::min(path.find('.', start), path.size());
        const std::string_view part = path.substr(start, end - start);
        const bool index = !part.empty() && std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; });
        if (!index && !name.empty()) name += '.';
        if (!index) name += part;
        start = end + 1;
    }
    return name;
}

bool isWholeKey(const std::string& path) {
    const Key* key = findKey(withoutIndices(path));
    return key != nullptr && key->type == Type::integer;
}

/// Frame and value of one key: [frame, value].
void addKey(AnimatedKey& key, const toml::node& node, double framesOfUnit) {
    const toml::array* pair = node.as_array();
    if (pair == nullptr || pair->size() != 2 || !pair->get(0)->is_number())
        throw InputError("a key of an animation is a frame and a value", key.where, "write [[0, 5.0], [120, 40.0]]");
    const double frame = framesOfUnit * pair->get(0)->value<double>().value_or(0.0);
    if (!std::isfinite(frame) || (!key.frames.empty() && frame <= key.frames.back()))
        throw InputError("the frames of an animation rise from key to key", key.where, "put them in their order");
    if (key.frames.empty()) key.whole = isWholeKey(key.path);
    Parts parts;
    take(*pair->get(1), key.whole, parts);
    if (!std::ranges::all_of(parts.numbers, [](double value) { return std::isfinite(value); }))
        throw InputError("values of an animation are finite", key.where, "leave out inf and nan");
    if (!parts.allNumbers) key.interpolation = Interpolation::step;
    if (!key.frames.empty() && key.shape != parts.shape && key.interpolation != Interpolation::step)
        throw InputError(fmt::format("between {} and {} there is nothing", key.texts.back(), parts.text), key.where,
                         "give values of one form, or interpolation = \"step\"");
    key.shape = parts.shape;
    key.frames.push_back(frame);
    key.numbers.push_back(std::move(parts.numbers));
    key.texts.push_back(std::move(parts.text));
}

double smoothly(double t) {
    return t * t * (3.0 - 2.0 * t);
}

/// Cubic between keys 1 and 2 with the slopes of their neighbours (Catmull-Rom for frames at any distance).
double onSpline(const std::array<double, 4>& at, const std::array<double, 4>& value, double frame) {
    const double span = at[2] - at[1], t = (frame - at[1]) / span;
    const auto slope = [&](std::size_t i) {
        return at[i + 1] > at[i - 1] ? (value[i + 1] - value[i - 1]) / (at[i + 1] - at[i - 1]) * span : 0.0;
    };
    const double a = slope(1), b = slope(2), t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * value[1] + (t3 - 2.0 * t2 + t) * a + (3.0 * t2 - 2.0 * t3) * value[2] +
           (t3 - t2) * b;
}

}  // namespace

std::string AnimatedKey::valueAt(double frame) const {
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(frames, frame) - frames.begin());
    if (after == 0) return texts.front();
    const std::size_t first = after - 1;
    if (after == frames.size() || interpolation == Interpolation::step || frame == frames[first]) return texts[first];
    const std::size_t before = first > 0 ? first - 1 : first, last = std::min(after + 1, frames.size() - 1);
    const double t = (frame - frames[first]) / (frames[after] - frames[first]);
    std::string text = shape;
    std::size_t place = 0;
    for (std::size_t i = 0; i < numbers[first].size(); ++i) {
        const double a = numbers[first][i], b = numbers[after][i];
        double value = a + (b - a) * (interpolation == Interpolation::smooth ? smoothly(t) : t);
        if (interpolation == Interpolation::spline)
            value = onSpline({frames[before], frames[first], frames[after], frames[last]},
                             {numbers[before][i], a, b, numbers[last][i]}, frame);
        const std::string number = textOf(value, whole);
        place = text.find('#', place);
        text.replace(place, 1, number);
        place += number.size();
    }
    return text;
}

Animation::Animation(const toml::node& section, const std::string& source,
                     std::span<const std::filesystem::path> folders) {
    const toml::table* table = section.as_table();
    if (table == nullptr)
        throw InputError("animate must be a table", fmt::format("{}:{}", source, section.source().begin.line),
                         "write [animate] and its keys below");
    if (const toml::node* fps = table->get("fps")) {
        fps_ = fps->value<double>().value_or(0.0);
        if (!(fps_ > 0.0 && fps_ <= 1e4))
            throw InputError("fps are frames a second, above 0 and at most 10000", placeOf(*fps, "fps", source),
                             "write fps = 24");
    }
    for (const auto& [name, node] : *table) {
        if (name == "fps") continue;
        if (name == "camera" && node.is_string()) {
            const std::filesystem::path beside = std::filesystem::path(source).parent_path();
            const std::filesystem::path path = beside / node.value<std::string>().value_or("");
            if (!isAllowed(path, folders))
                throw InputError(fmt::format("{} does not exist", path.string()), placeOf(node, "camera", source),
                                 "give a table of the camera's path, its path relative to the scene file");
            readCamera(path);
            continue;
        }
        read(node, std::string(name), source);
    }
}

void Animation::read(const toml::node& node, const std::string& path, const std::string& source) {
    AnimatedKey key;
    key.path = path;
    key.where = placeOf(node, path, source);
    double framesOfUnit = 1.0;
    const toml::node* keys = &node;
    if (const toml::table* table = node.as_table()) {
        keys = table->get("keys");
        if (keys == nullptr) {  // dotted keys that nobody has put in quotes
            for (const auto& [name, child] : *table) read(child, path + "." + std::string(name), source);
            return;
        }
        for (const auto& [name, value] : *table) {
            const auto text = value.value<std::string_view>().value_or("");
            if (name == "interpolation") {
                const auto* const known = std::ranges::find(names, text, [](const auto& each) { return each.first; });
                if (known == names.end())
                    throw InputError("unknown interpolation", placeOf(value, path, source),
                                     "write linear, smooth, step or spline");
                key.interpolation = known->second;
            } else if (name == "unit" && (text == "frame" || text == "second")) {
                framesOfUnit = text == "second" ? fps_ : 1.0;
            } else if (name != "keys") {
                throw InputError(fmt::format("unknown key or value \"{}\" of an animation", std::string(name)),
                                 placeOf(value, path, source),
                                 "an animation has keys, interpolation, and unit = \"frame\" or \"second\"");
            }
        }
    }
    const toml::array* list = keys->as_array();
    if (list == nullptr || list->empty() || list->size() > mostKeys)
        throw InputError(fmt::format("an animation has 1 to {} keys", mostKeys), key.where,
                         "write [[0, 5.0], [120, 40.0]]");
    for (const toml::node& each : *list) addKey(key, each, framesOfUnit);
    keys_.push_back(std::move(key));
}

/// Position and target of the camera, on splines.
void Animation::readCamera(const std::filesystem::path& path) {
    constexpr std::array<std::string_view, 7> columns{"frame", "x", "y", "z", "target_x", "target_y", "target_z"};
    const NumberTable table = readNumberTable(path, columns, mostKeys);
    if (table.rows() == 0) throw InputError("the camera path is empty", path.string(), "give it rows");
    for (const auto& [name, first] : {std::pair{"camera.position", 1U}, std::pair{"camera.target", 4U}}) {
        AnimatedKey key;
        key.path = name;
        key.where = path.string();
        key.interpolation = Interpolation::spline;
        key.shape = "[#, #, #]";
        for (std::size_t row = 0; row < table.rows(); ++row) {
            const double* const values = table.row(row);
            const double frame = values[0];
            if (!key.frames.empty() && frame <= key.frames.back())
                throw InputError(fmt::format("the frames of a camera path rise from row to row: row {}", row + 1),
                                 path.string(), "put them in their order");
            key.frames.push_back(frame);
            key.numbers.emplace_back(values + first, values + first + 3);
            key.texts.push_back(fmt::format("[{}, {}, {}]", values[first], values[first + 1], values[first + 2]));
        }
        keys_.push_back(std::move(key));
    }
}

}  // namespace lumulus::scene
