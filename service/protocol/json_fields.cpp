#include "service/protocol/json_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/text.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr int deepest = 16;

/// Reads JSON without building it, as far as it nests no deeper than allowed and no object has a key twice. (A parse
/// callback would do that while the values are built, but for each object that ends it looks through all of its
/// parent's: 64 KiB of small objects in a list take over a second.)
class ShapeCheck : public nlohmann::json_sax<json> {
  public:
    bool tooDeep() const { return depth_ > deepest; }
    const std::optional<std::string>& keyTwice() const { return keyTwice_; }

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool key(string_t& name) override {
        if (keys_.back().insert(name).second) return true;
        keyTwice_ = name;
        return false;
    }
    bool start_object(std::size_t) override {
        keys_.emplace_back();
        return ++depth_ <= deepest;
    }
    bool start_array(std::size_t) override { return ++depth_ <= deepest; }
    bool end_object() override {
        keys_.pop_back();
        return leave();
    }
    bool end_array() override { return leave(); }
    /// Syntax is judged by whoever builds the values.
    bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }

  private:
    bool leave() {
        --depth_;
        return true;
    }

    int depth_ = 0;
    std::vector<std::set<std::string>> keys_;  // of the objects that are open
    std::optional<std::string> keyTwice_;
};

void checkShape(std::string_view text) {
    ShapeCheck check;
    json::sax_parse(text, &check);
    if (check.tooDeep()) throw RequestError("bad_request", "the JSON nests deeper than " + std::to_string(deepest));
    if (check.keyTwice()) {
        const std::string key = shortened(oneLine(*check.keyTwice()), 60);
        throw RequestError("bad_request", "the JSON has the key " + key + " twice in one object", key);
    }
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
    checkShape(text);
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

std::string JsonFields::requiredText(const char* name, std::size_t longest) {
    auto given = text(name, longest);
    if (!given) refuse(place(name), "is missing");
    return *given;
}

std::uint64_t JsonFields::requiredCount(const char* name, std::uint64_t most) {
    const auto given = integer(name, 0, static_cast<std::int64_t>(most));
    if (!given) refuse(place(name), "is missing");
    return static_cast<std::uint64_t>(*given);
}

std::uint64_t JsonFields::requiredId(const char* name) {
    const json* value = find(name);
    if (value == nullptr) refuse(place(name), "is missing");
    if (value->is_number_unsigned()) return value->get<std::uint64_t>();
    if (value->is_number()) return requiredCount(name, std::uint64_t{1} << 53U);  // 3.0
    if (value->is_string()) {
        const auto& text = value->get_ref<const std::string&>();
        std::uint64_t id = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
        if (error == std::errc() && end == text.data() + text.size() && !text.empty()) return id;
    }
    refuse(place(name), "must be a whole number of 64 bits, or its digits as a string");
}

std::optional<std::variant<std::uint32_t, std::string>> JsonFields::indexOrName(const char* name, std::uint32_t most,
                                                                                std::size_t longest) {
    const json* value = find(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_string()) return shortText(*value, place(name), longest);
    return static_cast<std::uint32_t>(*integer(name, 0, most));
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
