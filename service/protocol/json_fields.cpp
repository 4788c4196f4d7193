#include "service/protocol/json_fields.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr int deepest = 16;

/// The parser would build what it reads; its depth shows before, from the brackets outside of strings.
bool nestsTooDeep(std::string_view text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '\\') {
            ++i;
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && (c == '[' || c == '{')) {
            if (++depth > deepest) return true;
        } else if (!quoted && (c == ']' || c == '}')) {
            --depth;
        }
    }
    return false;
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
    throw RequestError("bad_request", where + " " + what, where);
}

double finite(const json& value, const std::string& where, double low, double high) {
    if (!value.is_number()) refuse(where, "must be a number");
    const double number = value.get<double>();
    if (!(number >= low && number <= high)) {
        const auto text = [](double bound) { return json(bound).dump(); };
        refuse(where, "must lie between " + text(low) + " and " + text(high));
    }
    return number;
}

std::string shortText(const json& value, const std::string& where, std::size_t longest) {
    if (!value.is_string()) refuse(where, "must be a string");
    const auto& text = value.get_ref<const std::string&>();
    if (text.size() > longest) refuse(where, "is longer than " + std::to_string(longest) + " bytes");
    return text;
}

}  // namespace

json parseObject(std::string_view text) {
    if (text.empty()) return json::object();
    if (nestsTooDeep(text)) throw RequestError("bad_request", "the JSON nests deeper than " + std::to_string(deepest));
    try {
        json value = json::parse(text);
        if (!value.is_object()) throw RequestError("bad_request", "the JSON header must be an object");
        return value;
    } catch (const json::exception& e) {
        throw RequestError("bad_request", "the JSON header is no JSON: " + shortened(oneLine(e.what()), 200));
    }
}

JsonFields::JsonFields(const json& object, std::string path) : object_(object), path_(std::move(path)) {
    if (!object.is_object()) refuse(path_, "must be an object");
}

std::string JsonFields::place(std::string_view name) const {
    return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

const json* JsonFields::find(const char* name) {
    known_.emplace_back(name);
    const auto it = object_.find(name);
    return it == object_.end() || it->is_null() ? nullptr : &*it;
}

std::optional<double> JsonFields::number(const char* name, double low, double high) {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    return finite(*value, place(name), low, high);
}

std::optional<std::int64_t> JsonFields::integer(const char* name, std::int64_t low, std::int64_t high) {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    const double number = finite(*value, place(name), static_cast<double>(low), static_cast<double>(high));
    if (number != std::floor(number)) refuse(place(name), "must be a whole number");
    return static_cast<std::int64_t>(number);
}

std::optional<bool> JsonFields::flag(const char* name) {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    if (!value->is_boolean()) refuse(place(name), "must be true or false");
    return value->get<bool>();
}

std::optional<std::string> JsonFields::text(const char* name, std::size_t longest) {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    return shortText(*value, place(name), longest);
}

std::optional<std::size_t> JsonFields::choice(const char* name, std::initializer_list<std::string_view> choices) {
    const auto given = text(name, 100);
    if (!given) return std::nullopt;
    const auto* const it = std::find(choices.begin(), choices.end(), *given);
    if (it == choices.end()) {
        std::string all;
        for (const std::string_view choice : choices) all += (all.empty() ? "" : ", ") + std::string(choice);
        refuse(place(name), "must be one of: " + all);
    }
    return static_cast<std::size_t>(it - choices.begin());
}

std::optional<std::vector<double>> JsonFields::numbers(const char* name, std::size_t count, double low, double high) {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    if (!value->is_array() || value->size() != count)
        refuse(place(name), "must be " + std::to_string(count) + " numbers");
    std::vector<double> result;
    for (const json& element : *value) result.push_back(finite(element, place(name), low, high));
    return result;
}

std::optional<glm::dvec3> JsonFields::vector(const char* name, double low, double high) {
    const auto values = numbers(name, 3, low, high);
    if (!values) return std::nullopt;
    return glm::dvec3((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<std::vector<std::string>> JsonFields::texts(const char* name, std::size_t most, std::size_t longest) {
    const json* value = array(name, most);
    if (value == nullptr) return std::nullopt;
    std::vector<std::string> result;
    for (const json& element : *value) result.push_back(shortText(element, place(name), longest));
    return result;
}

const json* JsonFields::object(const char* name) {
    return find(name);
}

const json* JsonFields::array(const char* name, std::size_t most) {
    const json* value = find(name);
    if (value == nullptr) return nullptr;
    if (!value->is_array() || value->size() > most)
        refuse(place(name), "must be a list of at most " + std::to_string(most));
    return value;
}

void JsonFields::finish() const {
    for (const auto& [name, value] : object_.items())
        if (std::find(known_.begin(), known_.end(), name) == known_.end())
            refuse(place(shortened(oneLine(name), 60)), "is not known here: docs/protocol.md lists the fields");
}

}  // namespace lumulus::service
