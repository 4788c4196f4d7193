#include "service/net/config_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "scene/load.h"
#include "scene/toml_guard.h"

namespace lumulus::service {

namespace fs = std::filesystem;

ConfigReader::ConfigReader(const fs::path& path) : source_(path.string()), folder_(fs::absolute(path).parent_path()) {
    const std::string text = scene::readSceneText(path);
    scene::checkKeyDepth(text, source_);
    try {
        table_ = toml::parse(std::string_view(text), source_);
    } catch (const toml::parse_error& e) {
        throw InputError(std::string(e.description()), fmt::format("{}:{}", source_, e.source().begin.line),
                         "docs/service.md lists the keys");
    }
}

std::string ConfigReader::where(const std::string& key) const {
    const auto node = table_.at_path(key);
    return node ? fmt::format("{}:{}, {}", source_, node.node()->source().begin.line, key) : source_ + ", " + key;
}

toml::node_view<const toml::node> ConfigReader::find(const std::string& key) {
    known_.insert(key);
    return std::as_const(table_).at_path(key);
}

std::optional<std::string> ConfigReader::text(const std::string& key) {
    const auto node = find(key);
    if (!node) return std::nullopt;
    if (!node.is_string()) throw InputError("must be a string", where(key), "put it into quotes");
    return std::string(*node.value<std::string_view>());
}

std::optional<bool> ConfigReader::boolean(const std::string& key) {
    const auto node = find(key);
    if (!node) return std::nullopt;
    if (!node.is_boolean()) throw InputError("this must be true or false", where(key), "give true or false");
    return *node.value<bool>();
}

std::optional<fs::path> ConfigReader::path(const std::string& key) {
    const auto given = text(key);
    if (!given || given->empty()) return std::nullopt;
    return (folder_ / *given).lexically_normal();
}

void ConfigReader::number(const std::string& key, double& value, double low, double high) {
    const auto node = find(key);
    if (!node) return;
    const auto given = node.value<double>();
    if (!node.is_number() || !given || !(*given >= low && *given <= high))
        throw InputError(fmt::format("must be a number between {} and {}", low, high), where(key), "change it");
    value = *given;
}

void ConfigReader::wholeNumber(const std::string& key, double& value, double low, double high) {
    number(key, value, low, high);
    if (value != std::floor(value)) throw InputError("must be a whole number", where(key), "round it");
}

void ConfigReader::finish() const {
    for (const auto& [section, node] : table_) {
        const std::string name(section.str());
        const toml::table* keys = node.as_table();
        if (keys == nullptr) throw InputError("no such key", where(name), "docs/service.md lists the keys");
        for (const auto& [key, value] : *keys)
            if (const std::string full = name + "." + std::string(key.str()); !known_.contains(full))
                throw InputError("no such key", where(full), "docs/service.md lists the keys");
    }
}

}  // namespace lumulus::service
